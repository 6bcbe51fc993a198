"""xx and yy have a factor of 1/2, from the exponent."""

TASKS = ("15.3",)
LOSES = ("15.3.differences", "15.3.hidden")
REPLACE = [("gx * vx / 2, gx * vy, gy * vy / 2", "gx * vx, gx * vy, gy * vy")]
