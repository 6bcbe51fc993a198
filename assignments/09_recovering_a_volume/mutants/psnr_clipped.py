"""You clip the picture before you compare: errors beyond white and black count as well."""

TASKS = ("09.1",)
LOSES = ("09.1.values", "09.1.mean", "09.1.hidden")
REPLACE = [
    (
        "float(-10 * np.log10(np.mean((picture - truth) ** 2)))",
        "float(-10 * np.log10(np.mean((np.clip(picture, 0, 1) - truth) ** 2)))",
    )
]
