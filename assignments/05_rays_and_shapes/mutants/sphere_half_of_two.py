"""h is only half as long as it should be."""

TASKS = ("05.1",)
LOSES = ("05.1.outside", "05.1.inside", "05.1.misses", "05.1.far", "05.1.hidden")
REPLACE = [("half = np.sqrt(np.abs(rest))", "half = np.sqrt(np.abs(rest)) / 2")]
