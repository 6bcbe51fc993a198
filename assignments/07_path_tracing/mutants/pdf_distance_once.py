"""The distance is not squared."""

TASKS = ("07.1",)
LOSES = ("07.1.hidden", "07.1.solid_angle", "07.1.straight")
REPLACE = [
    (
        "pdf[rows[seen]] = distance[rows[seen]] ** 2 / small",
        "pdf[rows[seen]] = distance[rows[seen]] / small",
    )
]
