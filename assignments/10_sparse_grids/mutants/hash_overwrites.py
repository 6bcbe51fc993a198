"""A voxel whose slot is taken drives the other one out; it should look further."""

TASKS = ("10.3",)
LOSES = ("10.3.found", "10.3.again", "10.3.room", "10.3.hidden")
REPLACE = [("if entry[3] < 0 or (entry[:3] == voxel).all():", "if True:")]
