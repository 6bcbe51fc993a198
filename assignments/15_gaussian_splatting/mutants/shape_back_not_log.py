"""You differentiate by the scales: a logarithm has the factor s more."""

TASKS = ("15.1",)
LOSES = ("15.1.differences", "15.1.hidden")
REPLACE = [("np.sum(d_M * M, axis=1)", "np.sum(d_M * R, axis=1)")]
