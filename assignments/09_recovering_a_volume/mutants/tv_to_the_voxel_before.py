"""Your differences act on the voxel before: the neighbour is the next one."""

TASKS = ("09.4",)
LOSES = ("09.4.differences", "09.4.hidden")
REPLACE = [("np.roll(pull[axis], 1, axis=axis)", "np.roll(pull[axis], -1, axis=axis)")]
