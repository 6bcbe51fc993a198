"""Your D divides by q: it is q squared."""

TASKS = ("04.2",)
LOSES = ("04.2.energy", "04.2.hidden")
REPLACE = [
    (
        "lobe[up] = 1 / (2 * np.pi * alpha**2 * q**2 * L)",
        "lobe[up] = 1 / (2 * np.pi * alpha**2 * q * L)",
    )
]
