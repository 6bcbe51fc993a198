"""After the last slot comes slot 0: (9) is mod S."""

TASKS = ("10.3",)
LOSES = ("10.3.found", "10.3.again", "10.3.room", "10.3.hidden")
REPLACE = [
    (
        "entry = table[(slot + probe) % len(table)]",
        "entry = table[min(slot + probe, len(table) - 1)]",
    )
]
