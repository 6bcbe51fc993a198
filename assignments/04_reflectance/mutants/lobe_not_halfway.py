"""Your half vector is not of length 1."""

TASKS = ("04.2",)
LOSES = ("04.2.ball", "04.2.energy", "04.2.hidden")
REPLACE = [
    (
        ("o, i, alpha = wo[up], wi[up], roughness[up] ** 2\n    h = half_vector(o, i)"),
        ("o, i, alpha = wo[up], wi[up], roughness[up] ** 2\n    h = (o + i) / 2"),
    )
]
