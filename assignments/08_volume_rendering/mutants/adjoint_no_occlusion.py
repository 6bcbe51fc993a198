"""More extinction also hides all that lies behind the step: that part of d_sigma is missing."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.background", "08.2.walls", "08.2.hidden", "08.2.cost")
REPLACE = [
    ("d_sigma[:, k] = dt[:, k] * (after * v - left)", "d_sigma[:, k] = dt[:, k] * (after * v)")
]
