"""The values of the start were overwritten."""

TASKS = ("10.6",)
LOSES = ("10.6.start",)
REPLACE = [("values = adam.step(values, d_values)", "values[:] = adam.step(values, d_values)")]
