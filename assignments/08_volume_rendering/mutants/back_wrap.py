"""Your border wraps around: what lies beyond belongs to the voxel at the border."""

TASKS = ("08.5",)
LOSES = ("08.5.transpose", "08.5.hidden")
REPLACE = [
    ("where = np.clip(sizes * u - 0.5, 0, sizes - 1)", "where = sizes * u - 0.5"),
    ("floor = where.astype(int)", "floor = np.floor(where).astype(int)"),
    ("ceiling = np.minimum(floor + 1, sizes - 1)", "ceiling = floor + 1"),
    (
        "a, b, c = np.where(upper, ceiling, floor).T",
        "a, b, c = (np.where(upper, ceiling, floor) % sizes).T",
    ),
]
