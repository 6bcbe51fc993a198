"""The cosine at the lamp multiplies; it divides, as a slanted lamp looks smaller."""

TASKS = ("07.1",)
LOSES = (
    "07.1.hidden",
    "07.1.solid_angle",
)
REPLACE = [
    (
        (
            "pdf[rows[seen]] = distance[rows[seen]] ** 2 / (len(numbers) * area[seen] * "
            "facing[seen])"
        ),
        (
            "pdf[rows[seen]] = distance[rows[seen]] ** 2 * facing[seen] / (len(numbers) * "
            "area[seen])"
        ),
    ),
]
