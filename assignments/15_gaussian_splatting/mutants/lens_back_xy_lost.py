"""You halve the derivative of xy once too often."""

TASKS = ("15.2",)
LOSES = ("15.2.differences", "15.2.held", "15.2.hidden")
REPLACE = [("[[1, 0.5], [0.5, 1]]", "[[1, 0.25], [0.25, 1]]")]
