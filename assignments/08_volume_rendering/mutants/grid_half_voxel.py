"""Your samples lie half a voxel off: the middle of the first voxel is at u = 0.5 / X."""

TASKS = ("08.4",)
LOSES = ("08.4.centres", "08.4.products", "08.4.edge", "08.4.hidden")
REPLACE = [
    (
        "place = np.clip(u * counts - 0.5, 0, counts - 1)",
        "place = np.clip(u * counts, 0, counts - 1)",
    )
]
