"""The sign of the place where the ray is nearest is wrong."""

TASKS = ("05.1",)
LOSES = ("05.1.outside", "05.1.inside", "05.1.misses", "05.1.far", "05.1.hidden")
REPLACE = [("nearest = -np.sum(offset", "nearest = np.sum(offset")]
