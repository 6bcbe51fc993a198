"""You take all steps of a ray to be as long as the first."""

TASKS = ("08.1",)
LOSES = ("08.1.slabs", "08.1.split", "08.1.extremes", "08.1.hidden")
REPLACE = [("s = sigma * dt\n", "s = sigma * dt[:, :1]\n")]
