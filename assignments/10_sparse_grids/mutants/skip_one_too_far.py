"""The jump passes over the first sample of the next leaf."""

TASKS = ("10.2",)
LOSES = ("10.2.samples", "10.2.faces", "10.2.cost", "10.2.hidden")
REPLACE = [
    (
        "jump = np.ceil(np.minimum(ahead.min(axis=1), count))",
        "jump = np.ceil(np.minimum(ahead.min(axis=1), count)) + 1",
    )
]
