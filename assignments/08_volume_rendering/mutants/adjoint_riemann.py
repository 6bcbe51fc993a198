"""The derivative of T (1 - exp(-sigma dt)) by sigma dt is T exp(-sigma dt): yours is T."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.background", "08.2.walls", "08.2.hidden", "08.2.cost")
REPLACE = [("(after * v - left)", "(T * v - left)")]
