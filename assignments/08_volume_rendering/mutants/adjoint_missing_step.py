"""dt is missing in d_sigma: its direction is right and its length is not."""

TASKS = ("08.2",)
LOSES = (
    "08.2.differences",
    "08.2.background",
    "08.2.units",
    "08.2.walls",
    "08.2.hidden",
    "08.2.cost",
)
REPLACE = [("d_sigma[:, k] = dt[:, k] * (after * v - left)", "d_sigma[:, k] = after * v - left")]
