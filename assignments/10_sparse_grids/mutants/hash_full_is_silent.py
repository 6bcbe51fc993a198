"""A table without a free slot loses the voxel without a word."""

TASKS = ("10.3",)
LOSES = ("10.3.room",)
REPLACE = [('raise ValueError("no slot is free")', "pass")]
