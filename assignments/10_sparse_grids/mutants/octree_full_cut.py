"""A cube of full cells is cut down to single cells; it is one leaf, as an empty one is."""

TASKS = ("10.1",)
LOSES = ("10.1.one", "10.1.fewest", "10.1.hidden")
REPLACE = [("if block.all():", "if block.all() and len(block) == 1:")]
