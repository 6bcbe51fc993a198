"""t is that of the corner a, not of the place that is met."""

TASKS = ("05.2",)
LOSES = ("05.2.inside", "05.2.misses", "05.2.hidden")
REPLACE = [("t = np.sum(weights * ahead, axis=0)", "t = ahead[0]")]
