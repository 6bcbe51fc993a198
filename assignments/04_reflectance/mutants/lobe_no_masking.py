"""Your lobe lacks masking: facets hide each other."""

TASKS = ("04.2",)
LOSES = ("04.2.ball", "04.2.energy", "04.2.hidden")
REPLACE = [
    (
        ("    L = stretched(o, alpha) * i[:, 2] + stretched(i, alpha) * o[:, 2]\n    lobe ="),
        ("    L = 2 * o[:, 2] * i[:, 2]\n    lobe ="),
    )
]
