"""The derivative of an exponential is the exponential: the factor o G is missing."""

TASKS = ("15.3",)
LOSES = ("15.3.differences", "15.3.hidden")
REPLACE = [("raw * d_alpha, 0.0", "d_alpha, 0.0")]
