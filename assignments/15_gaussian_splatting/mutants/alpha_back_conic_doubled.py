"""You count the derivative of xy twice: both entries of the matrix are in it already."""

TASKS = ("15.3",)
LOSES = ("15.3.differences", "15.3.hidden")
REPLACE = [("gx * vx / 2, gx * vy, gy * vy / 2", "gx * vx / 2, 2 * gx * vy, gy * vy / 2")]
