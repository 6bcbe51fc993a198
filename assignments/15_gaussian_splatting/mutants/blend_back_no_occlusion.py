"""A splat that grows hides what is behind it: that half is missing."""

TASKS = ("15.4",)
LOSES = ("15.4.differences", "15.4.hidden")
REPLACE = [("T[:-1] * v - rest / (1 - a)", "T[:-1] * v")]
