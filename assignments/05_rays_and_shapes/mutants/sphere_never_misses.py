"""Rays that pass the sphere meet it: h squared below 0 is not looked at."""

TASKS = ("05.1",)
LOSES = ("05.1.misses", "05.1.hidden")
REPLACE = [("(rest >= 0) & (t > T_MIN)", "t > T_MIN")]
