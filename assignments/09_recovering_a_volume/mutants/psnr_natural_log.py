"""Your logarithm is the natural one: decibels are ten times the decimal logarithm."""

TASKS = ("09.1",)
LOSES = ("09.1.values", "09.1.mean", "09.1.hidden")
REPLACE = [
    (
        "float(-10 * np.log10(np.mean((picture - truth) ** 2)))",
        "float(-10 * np.log(np.mean((picture - truth) ** 2)))",
    )
]
