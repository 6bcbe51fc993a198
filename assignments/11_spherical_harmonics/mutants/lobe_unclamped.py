"""Your cosine goes on below the horizon: only directions above the surface count."""

TASKS = ("11.5",)
LOSES = ("11.5.constant", "11.5.lambert", "11.5.hidden")
REPLACE = [
    (
        ("    lobe = np.pi * np.array([1, 2 / 3, 1 / 4, 0, -1 / 24])\n"),
        ("    lobe = np.pi * np.array([0, 4 / 3, 0, 0, 0])\n"),
    )
]
