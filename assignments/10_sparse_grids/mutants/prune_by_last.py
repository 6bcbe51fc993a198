"""The last share that comes decides; the largest of all views should."""

TASKS = ("10.5",)
LOSES = ("10.5.pruned", "10.5.hidden")
REPLACE = [
    (
        "np.maximum.at(worth, row[row >= 0], share[row >= 0])",
        "worth[row[row >= 0]] = share[row >= 0]",
    )
]
