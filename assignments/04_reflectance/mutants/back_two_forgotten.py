"""The derivative of roughness^2 is 2 roughness: the 2 is missing."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.straight", "04.6.hidden")
REPLACE = [
    (
        ("(np.sum(d_f * mirrored, axis=1) * lobe * 2 * roughness)[up] * (of_D - of_V)"),
        "(np.sum(d_f * mirrored, axis=1) * lobe * roughness)[up] * (of_D - of_V)",
    )
]
