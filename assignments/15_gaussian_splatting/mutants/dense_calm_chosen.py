"""Only what is pressed above THRESHOLD is chosen."""

TASKS = ("15.6",)
LOSES = ("15.6.rows", "15.6.values", "15.6.hidden")
REPLACE = [("chosen = rows[(kept & (pressure > THRESHOLD))[rows]]", "chosen = rows[kept[rows]]")]
