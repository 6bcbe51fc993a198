"""The radius is not squared."""

TASKS = ("05.1",)
LOSES = ("05.1.outside", "05.1.inside", "05.1.misses", "05.1.hidden")
REPLACE = [("radius**2", "radius")]
