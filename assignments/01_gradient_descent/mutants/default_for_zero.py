"""beta = 0 becomes a default: `beta or 0.9` takes 0 for missing"""

TASKS = ("01.4",)
LOSES = ("01.4.plain",)
REPLACE = [("v = beta * v + grad", "v = (beta or 0.9) * v + grad")]
