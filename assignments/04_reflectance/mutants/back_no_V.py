"""Your derivative lacks that of V: masking changes with roughness, too."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.hidden")
REPLACE = [
    (
        ("(np.sum(d_f * mirrored, axis=1) * lobe * 2 * roughness)[up] * (of_D - of_V)"),
        "(np.sum(d_f * mirrored, axis=1) * lobe * 2 * roughness)[up] * of_D",
    )
]
