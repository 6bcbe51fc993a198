"""One weight has the lamp's density by area, the other by solid angle: no sum of 1."""

TASKS = ("07.3",)
LOSES = ("07.3.furnace", "07.3.hidden", "07.3.matte", "07.3.proposal")
REPLACE = [
    ("mine, theirs = by_surface, by_light", 'mine, theirs = by_surface, by_light / there["t"] ** 2')
]
