"""A difference pulls its two ends in opposite directions: yours pulls both the same way."""

TASKS = ("09.4",)
LOSES = ("09.4.differences", "09.4.balance", "09.4.hidden")
REPLACE = [("d_grid = -pull.sum(axis=0)", "d_grid = pull.sum(axis=0)")]
