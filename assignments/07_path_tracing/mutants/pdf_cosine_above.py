"""The cosine at the lamp multiplies; it divides, as a slanted lamp looks smaller."""

TASKS = ("07.1",)
LOSES = ("07.1.hidden", "07.1.solid_angle")
REPLACE = [
    (
        "small = len(numbers) * width[seen] * height[seen] * facing[seen]",
        "small = len(numbers) * width[seen] * height[seen] / facing[seen]",
    )
]
