"""Colours are cut off at 0 as well; only the extinction is."""

TASKS = ("10.6",)
LOSES = ("10.6.first", "10.6.hidden")
REPLACE = [("values[:, 3] = np.maximum(values[:, 3], 0)", "values = np.maximum(values, 0)")]
