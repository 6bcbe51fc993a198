"""You put the outermost values on the faces: they belong to the middles of voxels."""

TASKS = ("08.4",)
LOSES = ("08.4.centres", "08.4.products", "08.4.edge", "08.4.hidden")
REPLACE = [
    (
        "place = np.clip(u * counts - 0.5, 0, counts - 1)",
        "place = np.clip(u * (counts - 1), 0, counts - 1)",
    )
]
