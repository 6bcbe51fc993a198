"""Your gradient sends back the samples themselves, not their differences from the measurements."""

TASKS = ("03.3",)
LOSES = ("03.3.differences", "03.3.hidden")
REPLACE = [("2 * residual / count", "2 * (residual + target) / count")]
