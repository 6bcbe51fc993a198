"""Each box is asked for twice."""

TASKS = ("05.6",)
LOSES = ("05.6.cost", "05.6.hidden")
REPLACE = [("low, high = box(node)", "low, high = box(node)[0], box(node)[1]")]
