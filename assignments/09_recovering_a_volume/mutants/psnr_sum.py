"""You take the logarithm of the sum of squares: it is that of their mean."""

TASKS = ("09.1",)
LOSES = ("09.1.values", "09.1.hidden")
REPLACE = [
    (
        "float(-10 * np.log10(np.mean((picture - truth) ** 2)))",
        "float(-10 * np.log10(np.sum((picture - truth) ** 2)))",
    )
]
