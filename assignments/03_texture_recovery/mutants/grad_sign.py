"""Your gradient points the wrong way: the residual is texture minus measurement."""

TASKS = ("03.3",)
LOSES = ("03.3.differences", "03.3.hidden")
REPLACE = [("2 * residual / count", "-2 * residual / count")]
