"""Your d_sigma has the wrong sign: its own light counts plus, what it hides minus."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.background", "08.2.walls", "08.2.hidden", "08.2.cost")
REPLACE = [("(after * v - left)", "(left - after * v)")]
