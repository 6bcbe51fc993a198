"""Shares are added up; the largest one decides."""

TASKS = ("10.5",)
LOSES = ("10.5.pruned", "10.5.hidden")
REPLACE = [
    (
        "np.maximum.at(worth, row[row >= 0], share[row >= 0])",
        "np.add.at(worth, row[row >= 0], share[row >= 0])",
    )
]
