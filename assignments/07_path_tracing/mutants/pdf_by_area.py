"""The density is that by area; by solid angle it is r squared over the cosine as much."""

TASKS = ("07.1",)
LOSES = ("07.1.hidden", "07.1.solid_angle", "07.1.straight")
REPLACE = [
    (
        "small = len(numbers) * width[seen] * height[seen] * facing[seen]",
        "small = len(numbers) * width[seen] * height[seen]",
    ),
    ("pdf[rows[seen]] = distance[rows[seen]] ** 2 / small", "pdf[rows[seen]] = 1 / small"),
]
