"""Your weights are exchanged: the nearer voxel has the larger weight."""

TASKS = ("08.4",)
LOSES = ("08.4.centres", "08.4.products", "08.4.edge", "08.4.hidden")
REPLACE = [
    (
        "share = np.prod(np.where(corner, f, 1 - f), axis=1)",
        "share = np.prod(np.where(corner, 1 - f, f), axis=1)",
    )
]
