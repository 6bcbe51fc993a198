"""Cubes of two cells a side are not cut any more."""

TASKS = ("10.1",)
LOSES = ("10.1.cells", "10.1.one", "10.1.fewest", "10.1.hidden")
REPLACE = [("elif block.any():", "elif block.any() and len(block) > 2:")]
