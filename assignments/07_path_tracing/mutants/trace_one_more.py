"""Paths have one piece too many."""

TASKS = ("07.5",)
LOSES = ("07.5.corner", "07.5.emitted", "07.5.furnace", "07.5.hidden", "07.5.integral")
REPLACE = [("for bounce in range(depth - 1):", "for bounce in range(depth):")]
