"""The cosine at the lamp is missing: a lamp seen at a slant looks smaller."""

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
        "pdf[rows[seen]] = distance[rows[seen]] ** 2 / (len(numbers) * area[seen])",
    ),
]
