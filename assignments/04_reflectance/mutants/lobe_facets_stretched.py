"""Your D multiplies by alpha^2 where q divides."""

TASKS = ("04.2",)
LOSES = ("04.2.energy", "04.2.hidden")
REPLACE = [
    (
        ("q = (h[:, 0] ** 2 + h[:, 1] ** 2) / alpha**2 + h[:, 2] ** 2\n    L ="),
        ("q = (h[:, 0] ** 2 + h[:, 1] ** 2) * alpha**2 + h[:, 2] ** 2\n    L ="),
    )
]
