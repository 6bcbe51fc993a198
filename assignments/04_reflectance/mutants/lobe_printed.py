"""Your lobe has pi where the 4 of mirrors belongs, as the paper of 1982 has it."""

TASKS = ("04.2",)
LOSES = ("04.2.peak", "04.2.ball", "04.2.energy", "04.2.hidden")
REPLACE = [
    (
        "lobe[up] = 1 / (2 * np.pi * alpha**2 * q**2 * L)",
        "lobe[up] = 2 / (np.pi * np.pi * alpha**2 * q**2 * L)",
    )
]
