"""The upper corner of a box is made from the lower corners of things."""

TASKS = ("05.5",)
LOSES = ("05.5.boxes", "05.5.hidden")
REPLACE = [
    (
        "[low[mine].min(axis=0), high[mine].max(axis=0)]",
        "[low[mine].min(axis=0), low[mine].max(axis=0)]",
    )
]
