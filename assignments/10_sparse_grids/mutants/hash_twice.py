"""A voxel that is in the table already is put in a second time."""

TASKS = ("10.3",)
LOSES = ("10.3.again",)
REPLACE = [
    ("if entry[3] < 0 or (entry[:3] == voxel).all():", "if entry[3] < 0:"),
]
