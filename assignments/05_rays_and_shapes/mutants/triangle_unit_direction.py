"""The direction is taken to have length 1."""

TASKS = ("05.2",)
LOSES = ("05.2.inside", "05.2.misses", "05.2.hidden")
REPLACE = [("axis=2) / np.sum(direction**2)", "axis=2)")]
