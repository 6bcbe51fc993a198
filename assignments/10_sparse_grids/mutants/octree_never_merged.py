"""The tree goes down to single cells everywhere: nothing is saved."""

TASKS = ("10.1",)
LOSES = ("10.1.one", "10.1.fewest", "10.1.hidden")
REPLACE = [
    ("if block.all():", "if block.all() and len(block) == 1:"),
    ("elif block.any():", "elif len(block) > 1:"),
]
