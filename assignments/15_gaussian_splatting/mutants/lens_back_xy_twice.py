"""xy stands for two entries of a matrix: each of them gets half of its derivative."""

TASKS = ("15.2",)
LOSES = ("15.2.differences", "15.2.held", "15.2.hidden")
REPLACE = [("[[1, 0.5], [0.5, 1]]", "[[1, 1], [1, 1]]")]
