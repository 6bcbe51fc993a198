"""Your gradient is that of the sum: the loss is divided by N, so its gradient is too."""

TASKS = ("03.3",)
LOSES = ("03.3.differences", "03.3.hidden")
REPLACE = [("2 * residual / count", "2 * residual")]
