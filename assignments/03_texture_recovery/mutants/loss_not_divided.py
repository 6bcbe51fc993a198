"""Your loss is the sum: divide it, and its gradient, by the number of samples."""

TASKS = ("03.3",)
LOSES = ("03.3.value", "03.3.hidden")
REPLACE = [("count = len(uv)", "count = 1")]
