"""20 belongs to the root of the mean square error, 10 to the mean square error itself."""

TASKS = ("09.1",)
LOSES = ("09.1.values", "09.1.mean", "09.1.hidden")
REPLACE = [
    (
        "float(-10 * np.log10(np.mean((picture - truth) ** 2)))",
        "float(-20 * np.log10(np.mean((picture - truth) ** 2)))",
    )
]
