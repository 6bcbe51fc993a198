"""The inverse of a 2 x 2 matrix changes the sign of xy."""

TASKS = ("15.3",)
LOSES = ("15.3.ellipse", "15.3.differences", "15.3.hidden")
REPLACE = [("[1, -1, 1] / det", "[1, 1, 1] / det")]
