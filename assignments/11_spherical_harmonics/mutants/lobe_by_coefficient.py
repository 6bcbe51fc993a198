"""Your factors go by coefficient: all of a degree have the same."""

TASKS = ("11.5",)
LOSES = ("11.5.lambert", "11.5.hidden")
REPLACE = [
    (
        ("    lobe = np.repeat(lobe[: degree + 1], 2 * np.arange(degree + 1) + 1)\n"),
        ("    lobe = np.resize(lobe, K)\n"),
    )
]
