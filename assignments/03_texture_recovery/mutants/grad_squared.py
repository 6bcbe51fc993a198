"""Your gradient sends back the squared residuals."""

TASKS = ("03.3",)
LOSES = ("03.3.differences", "03.3.hidden")
REPLACE = [("2 * residual / count", "2 * residual**2 / count")]
