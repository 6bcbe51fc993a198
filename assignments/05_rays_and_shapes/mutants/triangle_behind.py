"""Triangles behind the origin are met, with t below 0."""

TASKS = ("05.2",)
LOSES = ("05.2.misses", "05.2.hidden")
REPLACE = [("met = inside & (t > T_MIN)", "met = inside")]
