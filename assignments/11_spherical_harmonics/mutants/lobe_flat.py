"""Your factor is pi for every degree: it falls with the degree."""

TASKS = ("11.5",)
LOSES = ("11.5.lambert", "11.5.hidden")
REPLACE = [
    (
        ("    lobe = np.pi * np.array([1, 2 / 3, 1 / 4, 0, -1 / 24])\n"),
        ("    lobe = np.full(5, np.pi)\n"),
    )
]
