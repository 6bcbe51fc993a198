"""Your derivative is by alpha: alpha is the roughness squared, so 2 roughness comes along."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.straight", "04.6.hidden")
REPLACE = [
    (
        ("(np.sum(d_f * mirrored, axis=1) * lobe * 2 * roughness)[up] * (of_D - of_V)"),
        "(np.sum(d_f * mirrored, axis=1) * lobe)[up] * (of_D - of_V)",
    )
]
