"""dx and dy are swapped."""

TASKS = ("15.3",)
LOSES = ("15.3.ellipse", "15.3.differences", "15.3.hidden")
REPLACE = [("dx, dy = (mean2d", "dy, dx = (mean2d")]
