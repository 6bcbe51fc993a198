"""The alpha of your density is the roughness: it is the roughness squared."""

TASKS = ("04.3",)
LOSES = ("04.3.mass", "04.3.hidden")
REPLACE = [(("roughness[up] ** 2\n    length"), ("roughness[up]\n    length"))]
