"""Faint ones go: below FAINT."""

TASKS = ("15.6",)
LOSES = ("15.6.rows", "15.6.values", "15.6.most", "15.6.hidden")
REPLACE = [("kept = opacity >= FAINT", "kept = opacity >= 0")]
