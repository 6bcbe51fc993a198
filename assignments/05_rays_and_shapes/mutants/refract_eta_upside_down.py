"""The ratio is upside down: light bends away from the normal in glass."""

TASKS = ("05.3",)
LOSES = ("05.3.snell", "05.3.back", "05.3.total", "05.3.hidden")
REPLACE = [("ratio = eta**side", "ratio = eta**-side")]
