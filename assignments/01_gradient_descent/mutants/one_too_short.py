"""your step length is one step shorter than needed"""

TASKS = ("01.6",)
LOSES = ("01.6.armijo", "01.6.descends")
REPLACE = [("    return tau\n", "    return tau * shrink\n")]
