"""The derivative of xy is halved once too often: what is kept halved is doubled later."""

TASKS = ("15.3",)
LOSES = ("15.3.differences", "15.3.hidden")
REPLACE = [("gx * vx / 2, gx * vy, gy * vy / 2", "gx * vx / 2, gx * vy / 2, gy * vy / 2")]
