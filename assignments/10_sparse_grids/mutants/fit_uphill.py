"""The steps go uphill."""

TASKS = ("10.6",)
LOSES = ("10.6.first", "10.6.chain", "10.6.hidden", "10.6.topology")
REPLACE = [("adam.step(values, d_values)", "adam.step(values, -d_values)")]
