"""Colours are cut off, to 0 and 1; only the extinction is, and only below."""

TASKS = ("10.6",)
LOSES = ("10.6.first", "10.6.hidden")
REPLACE = [
    (
        "values[:, 3] = np.maximum(values[:, 3], 0)",
        "values = np.clip(values, 0, [1.0, 1.0, 1.0, np.inf])",
    )
]
