"""Your D is Beckmann's: the tails of GGX are longer."""

TASKS = ("04.2",)
LOSES = ("04.2.ball", "04.2.energy", "04.2.hidden")
REPLACE = [
    (
        "lobe[up] = 1 / (2 * np.pi * alpha**2 * q**2 * L)",
        (
            "t = (1 - h[:, 2] ** 2) / (alpha * h[:, 2]) ** 2\n"
            "    lobe[up] = np.exp(-t) / (2 * np.pi * alpha**2 * h[:, 2] ** 4 * L)"
        ),
    )
]
