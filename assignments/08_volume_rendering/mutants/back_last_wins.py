"""`A[index] += values` adds once for an index that occurs twice: only the last sample counts."""

TASKS = ("08.5",)
LOSES = ("08.5.transpose", "08.5.repeated", "08.5.hidden")
REPLACE = [
    ("np.add.at(d_grid, (a, b, c), part[:, None] * g)", "d_grid[a, b, c] += part[:, None] * g")
]
