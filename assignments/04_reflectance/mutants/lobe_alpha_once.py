"""Your D divides by alpha once: a patch has two axes."""

TASKS = ("04.2",)
LOSES = ("04.2.peak", "04.2.energy", "04.2.hidden")
REPLACE = [
    (
        "lobe[up] = 1 / (2 * np.pi * alpha**2 * q**2 * L)",
        "lobe[up] = 1 / (2 * np.pi * alpha * q**2 * L)",
    )
]
