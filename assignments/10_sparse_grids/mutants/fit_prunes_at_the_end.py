"""The list is made anew after the last round as well; it is made anew between two rounds."""

TASKS = ("10.6",)
LOSES = ("10.6.first", "10.6.chain", "10.6.hidden")
REPLACE = [("if number < rounds - 1:", "if number < rounds:")]
