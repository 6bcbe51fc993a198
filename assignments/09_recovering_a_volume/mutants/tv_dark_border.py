"""Beyond your far border lies 0: there is no difference there."""

TASKS = ("09.4",)
LOSES = ("09.4.values", "09.4.differences", "09.4.balance", "09.4.hidden")
REPLACE = [("append=grid.take([-1], axis=axis)", "append=0 * grid.take([-1], axis=axis)")]
