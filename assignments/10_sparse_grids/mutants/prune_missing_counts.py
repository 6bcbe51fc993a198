"""Shares of missing voxels, row -1, count for the last voxel."""

TASKS = ("10.5",)
LOSES = ("10.5.pruned", "10.5.hidden")
REPLACE = [
    ("np.maximum.at(worth, row[row >= 0], share[row >= 0])", "np.maximum.at(worth, row, share)")
]
