"""Your derivative lacks that of D."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.straight", "04.6.hidden")
REPLACE = [
    (
        ("(np.sum(d_f * mirrored, axis=1) * lobe * 2 * roughness)[up] * (of_D - of_V)"),
        "(np.sum(d_f * mirrored, axis=1) * lobe * 2 * roughness)[up] * -of_V",
    )
]
