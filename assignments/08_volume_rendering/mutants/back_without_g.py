"""You hand out weights, not g times weights."""

TASKS = ("08.5",)
LOSES = ("08.5.single", "08.5.transpose", "08.5.repeated", "08.5.hidden")
REPLACE = [
    (
        "np.add.at(d_grid, (a, b, c), part[:, None] * g)",
        "np.add.at(d_grid, (a, b, c), part[:, None] + 0 * g)",
    )
]
