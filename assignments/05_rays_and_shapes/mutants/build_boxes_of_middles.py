"""Boxes hold the middles of things, not the things."""

TASKS = ("05.5",)
LOSES = ("05.5.boxes", "05.5.hidden")
REPLACE = [
    (
        "[low[mine].min(axis=0), high[mine].max(axis=0)]",
        "[twice_middle[mine].min(axis=0) / 2, twice_middle[mine].max(axis=0) / 2]",
    )
]
