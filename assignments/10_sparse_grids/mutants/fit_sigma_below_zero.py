"""Extinctions fall below 0; cut them off after each step."""

TASKS = ("10.6",)
LOSES = ("10.6.first", "10.6.hidden")
REPLACE = [("values[:, 3] = np.maximum(values[:, 3], 0)", "pass")]
