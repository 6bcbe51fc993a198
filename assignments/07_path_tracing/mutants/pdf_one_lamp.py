"""The choice among K lamps is forgotten: each is drawn only a K-th of the time."""

TASKS = ("07.1",)
LOSES = ("07.1.hidden", "07.1.solid_angle", "07.1.straight")
REPLACE = [
    (
        "small = len(numbers) * width[seen] * height[seen] * facing[seen]",
        "small = width[seen] * height[seen] * facing[seen]",
    )
]
