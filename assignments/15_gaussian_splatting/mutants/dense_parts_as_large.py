"""A part is smaller than the whole, by SHRINK."""

TASKS = ("15.6",)
LOSES = ("15.6.values", "15.6.hidden")
REPLACE = [(('    after["log_scales"][fresh] -= np.log(SHRINK)\n'), "")]
