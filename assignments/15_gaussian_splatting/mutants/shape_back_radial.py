"""The part along q must go: a longer q is the same Gaussian."""

TASKS = ("15.1",)
LOSES = ("15.1.differences", "15.1.length", "15.1.hidden")
REPLACE = [("(d_n - along * n) / length", "d_n / length")]
