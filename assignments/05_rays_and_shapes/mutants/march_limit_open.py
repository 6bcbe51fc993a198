"""A surface at t_max itself is not met."""

TASKS = ("05.4",)
LOSES = ("05.4.cost",)
REPLACE = [("live = live[~there & (t[live] <= t_max)]", "live = live[~there & (t[live] < t_max)]")]
