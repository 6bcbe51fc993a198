"""A value stands in the difference of the voxel before it, too: that part of d_grid is missing."""

TASKS = ("09.4",)
LOSES = ("09.4.differences", "09.4.balance", "09.4.hidden")
REPLACE = [("d_grid += moved", "d_grid += 0 * moved")]
