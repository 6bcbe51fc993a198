"""Scale j belongs to column j of M: you sum over the other index."""

TASKS = ("15.1",)
LOSES = ("15.1.differences", "15.1.hidden")
REPLACE = [("np.sum(d_M * M, axis=1)", "np.sum(d_M * M, axis=2)")]
