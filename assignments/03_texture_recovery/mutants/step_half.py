"""Your step is half as long as it should be: 2 over the curvature, not 1."""

TASKS = ("03.5",)
LOSES = ("03.5.step",)
REPLACE = [("SAFETY * 2 /", "SAFETY /")]
