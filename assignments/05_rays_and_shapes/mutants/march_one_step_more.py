"""A ray may ask once more than `steps` times."""

TASKS = ("05.4",)
LOSES = ("05.4.cost", "05.4.hidden")
REPLACE = [("range(steps)", "range(steps + 1)")]
