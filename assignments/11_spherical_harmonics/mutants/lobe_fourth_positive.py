"""Your factor of degree 4 has the wrong sign."""

TASKS = ("11.5",)
LOSES = ("11.5.lambert", "11.5.hidden")
REPLACE = [
    (
        ("    lobe = np.pi * np.array([1, 2 / 3, 1 / 4, 0, -1 / 24])\n"),
        ("    lobe = np.pi * np.array([1, 2 / 3, 1 / 4, 0, 1 / 24])\n"),
    )
]
