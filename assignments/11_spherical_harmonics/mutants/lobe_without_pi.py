"""Your factors are 1, 2/3, 1/4: the pi is missing, as if the surface had reflected already."""

TASKS = ("11.5",)
LOSES = ("11.5.constant", "11.5.lambert", "11.5.hidden")
REPLACE = [
    (
        ("    lobe = np.pi * np.array([1, 2 / 3, 1 / 4, 0, -1 / 24])\n"),
        ("    lobe = np.array([1, 2 / 3, 1 / 4, 0, -1 / 24])\n"),
    )
]
