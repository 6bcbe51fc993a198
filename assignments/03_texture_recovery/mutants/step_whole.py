"""Your step is the largest stable one itself: SAFETY is missing."""

TASKS = ("03.5",)
LOSES = ("03.5.step", "03.5.recovers")
REPLACE = [("SAFETY * 2 /", "2 /")]
