"""You return the derivative by A, B, C: what is asked for is that by the covariance."""

TASKS = ("15.3",)
LOSES = ("15.3.differences", "15.3.hidden")
REPLACE = [
    ("gx * vx / 2, gx * vy, gy * vy / 2", "-g * dx * dx / 2, -g * dx * dy, -g * dy * dy / 2")
]
