"""A direction with a component of 0 misses where it runs outside the two planes."""

TASKS = ("08.3",)
LOSES = ("08.3.parallel", "08.3.hidden")
REPLACE = [("np.where(between, -np.inf, np.inf)", "np.where(between, -np.inf, -np.inf)")]
