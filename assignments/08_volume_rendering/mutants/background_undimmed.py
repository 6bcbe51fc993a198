"""The background is added undimmed: it is multiplied by T_end."""

TASKS = ("08.1",)
LOSES = ("08.1.constant", "08.1.slabs", "08.1.weights", "08.1.extremes", "08.1.hidden")
REPLACE = [("T_end[:, None] * background, T_end", "background, T_end")]
