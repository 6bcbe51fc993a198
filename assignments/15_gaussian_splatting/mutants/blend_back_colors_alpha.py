"""A colour counts T alpha: yours counts alpha."""

TASKS = ("15.4",)
LOSES = ("15.4.differences", "15.4.hidden")
REPLACE = [("d_colors[order] = w @ d_shown", "d_colors[order] = a @ d_shown")]
