"""A cube of two cells a side counts as full as soon as one of its cells is."""

TASKS = ("10.1",)
LOSES = ("10.1.cells", "10.1.one", "10.1.fewest", "10.1.hidden")
REPLACE = [("if block.all():", "if block.all() or (len(block) == 2 and block.any()):")]
