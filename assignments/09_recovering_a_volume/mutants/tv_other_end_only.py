"""A value stands in its own differences as well, with a minus: that part of d_grid is missing."""

TASKS = ("09.4",)
LOSES = ("09.4.differences", "09.4.balance", "09.4.hidden")
REPLACE = [("d_grid = -pull.sum(axis=0)", "d_grid = 0 * pull.sum(axis=0)")]
