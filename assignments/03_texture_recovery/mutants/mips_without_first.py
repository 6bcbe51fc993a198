"""Level 0, the texture itself, is missing."""

TASKS = ("03.6",)
LOSES = ("03.6.mean", "03.6.spot", "03.6.hidden")
REPLACE = [(("    return levels\n"), ("    return levels[1:] or levels\n"))]
