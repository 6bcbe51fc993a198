"""Your alpha is the roughness: it is the roughness squared."""

TASKS = ("04.2",)
LOSES = ("04.2.peak", "04.2.energy", "04.2.hidden")
REPLACE = [
    (
        ("o, i, alpha = wo[up], wi[up], roughness[up] ** 2\n    h = half_vector(o, i)"),
        ("o, i, alpha = wo[up], wi[up], roughness[up]\n    h = half_vector(o, i)"),
    )
]
