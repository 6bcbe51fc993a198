"""The exponent has a factor of 1/2."""

TASKS = ("15.3",)
LOSES = ("15.3.round", "15.3.ellipse", "15.3.cuts", "15.3.differences", "15.3.hidden")
REPLACE = [("(dx * vx + dy * vy) / 2", "(dx * vx + dy * vy)")]
