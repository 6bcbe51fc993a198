"""Every node has the box of all things."""

TASKS = ("05.5",)
LOSES = ("05.5.boxes", "05.5.hidden")
REPLACE = [
    ("[low[mine].min(axis=0), high[mine].max(axis=0)]", "[low.min(axis=0), high.max(axis=0)]")
]
