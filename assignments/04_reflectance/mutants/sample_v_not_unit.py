"""Your stretched viewer is not of length 1."""

TASKS = ("04.4",)
LOSES = ("04.4.mirror", "04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [("    viewer = viewer / np.linalg.norm(viewer, axis=1, keepdims=True)\n", "")]
