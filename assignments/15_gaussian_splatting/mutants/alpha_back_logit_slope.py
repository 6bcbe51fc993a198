"""The slope of 1 / (1 + exp(-x)) is o (1 - o): you forget 1 - o."""

TASKS = ("15.3",)
LOSES = ("15.3.differences", "15.3.hidden")
REPLACE = [("(1 - o) * g.sum(axis=1)", "g.sum(axis=1)")]
