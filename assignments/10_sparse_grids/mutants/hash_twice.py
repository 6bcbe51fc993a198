"""The voxel is there already: overwrite its slot, take no second one."""

TASKS = ("10.3",)
LOSES = ("10.3.again",)
REPLACE = [("if entry[3] < 0 or (entry[:3] == voxel).all():", "if entry[3] < 0:")]
