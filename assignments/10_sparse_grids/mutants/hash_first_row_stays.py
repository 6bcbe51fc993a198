"""A voxel that comes again keeps its old row; the latest counts."""

TASKS = ("10.3",)
LOSES = ("10.3.again",)
REPLACE = [
    (
        "entry[:3], entry[3] = voxel, row",
        "entry[:3], entry[3] = voxel, row if entry[3] < 0 else entry[3]",
    )
]
