"""Scales are logarithms: subtract the logarithm of SHRINK."""

TASKS = ("15.6",)
LOSES = ("15.6.values", "15.6.hidden")
REPLACE = [("[fresh] -= np.log(SHRINK)", "[fresh] -= SHRINK")]
