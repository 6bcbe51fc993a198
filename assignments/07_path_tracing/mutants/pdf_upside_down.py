"""It is 1 over the density."""

TASKS = ("07.1",)
LOSES = (
    "07.1.hidden",
    "07.1.solid_angle",
    "07.1.straight",
)
REPLACE = [
    (
        (
            "pdf[rows[seen]] = distance[rows[seen]] ** 2 / (len(numbers) * area[seen] * "
            "facing[seen])"
        ),
        ("pdf[rows[seen]] = len(numbers) * area[seen] * facing[seen] / distance[rows[seen]] ** 2"),
    ),
]
