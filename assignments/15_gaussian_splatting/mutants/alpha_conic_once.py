"""B stands for two entries of the matrix: the exponent has B dx dy, not half of it."""

TASKS = ("15.3",)
LOSES = ("15.3.ellipse", "15.3.differences", "15.3.hidden")
REPLACE = [
    (
        "vx, vy = A * dx + B * dy, B * dx + C * dy",
        "vx, vy = A * dx + B / 2 * dy, B / 2 * dx + C * dy",
    )
]
