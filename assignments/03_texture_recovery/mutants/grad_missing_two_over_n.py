"""Your gradient lacks the factor 2/N."""

TASKS = ("03.3",)
LOSES = ("03.3.differences", "03.3.hidden")
REPLACE = [("2 * residual / count", "residual")]
