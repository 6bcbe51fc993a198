"""Your lobe contains the cosine of the light: f does not."""

TASKS = ("04.2",)
LOSES = ("04.2.ball", "04.2.symmetry", "04.2.energy", "04.2.hidden")
REPLACE = [
    (
        "lobe[up] = 1 / (2 * np.pi * alpha**2 * q**2 * L)",
        "lobe[up] = i[:, 2] / (2 * np.pi * alpha**2 * q**2 * L)",
    )
]
