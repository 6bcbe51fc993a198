"""Your places lie half a voxel off: the middle of the first voxel is at u = 0.5 / X."""

TASKS = ("08.5",)
LOSES = ("08.5.single", "08.5.transpose", "08.5.hidden")
REPLACE = [
    ("where = np.clip(sizes * u - 0.5, 0, sizes - 1)", "where = np.clip(sizes * u, 0, sizes - 1)")
]
