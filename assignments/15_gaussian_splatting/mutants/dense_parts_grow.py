"""A part is smaller than the whole: yours is a little larger."""

TASKS = ("15.6",)
LOSES = ("15.6.values", "15.6.hidden")
REPLACE = [("[fresh] -= np.log(SHRINK)", "[fresh] += np.log(SHRINK) / 5")]
