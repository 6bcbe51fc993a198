"""Each round starts all voxels anew; those that were there keep their values."""

TASKS = ("10.6",)
LOSES = ("10.6.chain", "10.6.hidden", "10.6.topology")
REPLACE = [("np.where(old[:, None] >= 0, values[old], START)", "np.tile(START, (len(old), 1))")]
