"""Metalness 1 is your dielectric: it should be the metal."""

TASKS = ("04.5",)
LOSES = ("04.5.straight", "04.5.mirror", "04.5.energy", "04.5.hidden")
REPLACE = [(("m = metalness[:, None]\n    return"), ("m = 1 - metalness[:, None]\n    return"))]
