"""What goes because it is faint is not cloned either."""

TASKS = ("15.6",)
LOSES = ("15.6.hidden",)
REPLACE = [
    (
        "chosen = rows[(kept & (pressure > THRESHOLD))[rows]]",
        "chosen = rows[(pressure > THRESHOLD)[rows]]",
    )
]
