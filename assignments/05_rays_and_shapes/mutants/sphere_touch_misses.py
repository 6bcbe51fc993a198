"""A ray that touches the sphere in one place misses it."""

TASKS = ("05.1",)
LOSES = ("05.1.misses",)
REPLACE = [("rest >= 0", "rest > 0")]
