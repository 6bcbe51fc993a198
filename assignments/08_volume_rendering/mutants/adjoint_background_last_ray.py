"""All rays see the same background: you keep the share of the last one."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.background", "08.2.linear", "08.2.hidden", "08.2.cost")
REPLACE = [("return d_sigma, d_color, T @ d_pixel", "return d_sigma, d_color, T[-1] * d_pixel[-1]")]
