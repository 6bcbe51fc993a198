"""The inverse of a 2 x 2 matrix swaps xx and yy."""

TASKS = ("15.3",)
LOSES = ("15.3.ellipse", "15.3.differences", "15.3.hidden")
REPLACE = [("S[:, ::-1] *", "S *")]
