"""A cov A^T holds A twice: d_A has a factor of 2."""

TASKS = ("15.2",)
LOSES = ("15.2.differences", "15.2.held", "15.2.hidden")
REPLACE = [("d_A = 2 * G @ A @ cov", "d_A = G @ A @ cov")]
