"""You draw what is in front by less than NEAR."""

TASKS = ("15.5",)
LOSES = ("15.5.behind",)
REPLACE = [(("camera) > NEAR\n    part"), ("camera) > 0\n    part"))]
