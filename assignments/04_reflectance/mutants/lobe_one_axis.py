"""Your q has only the x of the half vector: y is missing."""

TASKS = ("04.2",)
LOSES = ("04.2.ball", "04.2.symmetry", "04.2.energy", "04.2.hidden")
REPLACE = [
    (
        ("q = (h[:, 0] ** 2 + h[:, 1] ** 2) / alpha**2 + h[:, 2] ** 2\n    L ="),
        ("q = h[:, 0] ** 2 / alpha**2 + h[:, 2] ** 2\n    L ="),
    )
]
