"""The step's length is missing: sigma dt is a number, sigma alone is 1/m."""

TASKS = ("08.1",)
LOSES = ("08.1.constant", "08.1.slabs", "08.1.split", "08.1.extremes", "08.1.order", "08.1.hidden")
REPLACE = [("s = sigma * dt\n", "s = sigma + 0 * dt\n")]
