"""The mean share decides: what one view needs is lost among those that do not see it."""

TASKS = ("10.5",)
LOSES = ("10.5.pruned", "10.5.hidden")
REPLACE = [
    (
        "np.maximum.at(worth, row[row >= 0], share[row >= 0])",
        (
            "np.add.at(worth, row[row >= 0], share[row >= 0])\n"
            "    worth /= np.maximum(np.bincount(row[row >= 0], minlength=len(worth)), 1)"
        ),
    )
]
