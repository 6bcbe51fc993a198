"""Your lobe is half of what it should be: look at the 2 of V again."""

TASKS = ("04.2",)
LOSES = ("04.2.peak", "04.2.ball", "04.2.energy", "04.2.hidden")
REPLACE = [
    (
        "lobe[up] = 1 / (2 * np.pi * alpha**2 * q**2 * L)",
        "lobe[up] = 1 / (4 * np.pi * alpha**2 * q**2 * L)",
    )
]
