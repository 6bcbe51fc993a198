"""What is behind is seen less: minus."""

TASKS = ("15.4",)
LOSES = ("15.4.differences", "15.4.hidden")
REPLACE = [("T[:-1] * v - rest / (1 - a)", "T[:-1] * v + rest / (1 - a)")]
