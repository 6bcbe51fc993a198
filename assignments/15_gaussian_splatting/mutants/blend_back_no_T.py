"""A splat is dimmed by what is in front of it: the factor T is missing."""

TASKS = ("15.4",)
LOSES = ("15.4.differences", "15.4.hidden")
REPLACE = [("T[:-1] * v - rest / (1 - a)", "v - rest / (1 - a)")]
