"""You mirror at a facet that is not of length 1."""

TASKS = ("04.4",)
LOSES = ("04.4.mirror", "04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [("    h = h / np.linalg.norm(h, axis=1, keepdims=True)\n", "")]
