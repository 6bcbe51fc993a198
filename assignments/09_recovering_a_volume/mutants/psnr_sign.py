"""More decibels are better: the logarithm of a small error is negative, so mind the sign."""

TASKS = ("09.1",)
LOSES = ("09.1.values", "09.1.mean", "09.1.hidden")
REPLACE = [
    (
        "float(-10 * np.log10(np.mean((picture - truth) ** 2)))",
        "float(10 * np.log10(np.mean((picture - truth) ** 2)))",
    )
]
