"""The faces belong to the box: a ray within a face is inside."""

TASKS = ("08.3",)
LOSES = ("08.3.parallel",)
REPLACE = [("(origins >= low) & (origins <= high)", "(origins > low) & (origins < high)")]
