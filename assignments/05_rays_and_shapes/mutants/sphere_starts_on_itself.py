"""A ray that starts on the sphere takes its start for the first place."""

TASKS = ("05.1",)
LOSES = ("05.1.inside", "05.1.misses", "05.1.hidden")
REPLACE = [("nearest - half > T_MIN, nearest - half", "nearest - half > -T_MIN, nearest - half")]
