"""No light gets through."""

TASKS = ("05.3",)
LOSES = ("05.3.snell", "05.3.back", "05.3.total", "05.3.hidden")
REPLACE = [("through = square > 0", "through = square > 1")]
