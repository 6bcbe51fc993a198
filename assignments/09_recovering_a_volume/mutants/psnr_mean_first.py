"""You square the mean error: take the mean of the squared errors."""

TASKS = ("09.1",)
LOSES = ("09.1.mean", "09.1.hidden")
REPLACE = [
    (
        "float(-10 * np.log10(np.mean((picture - truth) ** 2)))",
        "float(-20 * np.log10(np.mean(np.abs(picture - truth))))",
    )
]
