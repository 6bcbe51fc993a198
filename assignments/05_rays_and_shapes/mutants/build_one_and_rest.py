"""One thing is split off at a time: the tree is a list."""

TASKS = ("05.5",)
LOSES = ("05.5.halves", "05.5.hidden")
REPLACE = [("half = (start + stop) // 2", "half = start + 1")]
