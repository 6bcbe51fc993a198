"""The background is behind every splat."""

TASKS = ("15.4",)
LOSES = ("15.4.differences", "15.4.hidden")
REPLACE = [("rest = end + np.sum", "rest = 0 * end + np.sum")]
