"""Rays that have arrived are asked for again and again."""

TASKS = ("05.4",)
LOSES = ("05.4.met", "05.4.derivative", "05.4.cost", "05.4.hidden")
REPLACE = [("live = live[~there & (t[live] <= t_max)]", "live = live[t[live] <= t_max]")]
