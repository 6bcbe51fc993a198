"""Rays are followed beyond t_max."""

TASKS = ("05.4",)
LOSES = ("05.4.cost", "05.4.hidden")
REPLACE = [("live = live[~there & (t[live] <= t_max)]", "live = live[~there]")]
