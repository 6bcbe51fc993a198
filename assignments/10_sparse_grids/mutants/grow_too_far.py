"""It grows by one voxel more than was asked for."""

TASKS = ("10.5",)
LOSES = ("10.5.pruned", "10.5.grown", "10.5.hidden")
REPLACE = [
    ("active = np.zeros((n, n, n), bool)", "active, steps = np.zeros((n, n, n), bool), steps + 1")
]
