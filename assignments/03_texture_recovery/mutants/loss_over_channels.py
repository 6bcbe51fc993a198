"""Your loss divides by samples times channels: divide by the number of samples."""

TASKS = ("03.3",)
LOSES = ("03.3.value", "03.3.hidden")
REPLACE = [("count = len(uv)", "count = target.size")]
