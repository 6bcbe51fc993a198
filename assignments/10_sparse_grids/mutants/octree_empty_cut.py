"""A cube of empty cells is cut down to single cells; it is one leaf, as a full one is."""

TASKS = ("10.1",)
LOSES = ("10.1.one", "10.1.fewest", "10.1.hidden")
REPLACE = [("elif block.any():", "elif len(block) > 1:")]
