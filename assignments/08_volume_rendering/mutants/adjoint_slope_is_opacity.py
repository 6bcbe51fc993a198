"""The derivative of 1 - exp(-x) is exp(-x): yours is 1 - exp(-x) itself."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.background", "08.2.walls", "08.2.hidden", "08.2.cost")
REPLACE = [("(after * v - left)", "(weight * v - left)")]
