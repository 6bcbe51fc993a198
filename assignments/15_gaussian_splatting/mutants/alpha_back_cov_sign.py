"""A wider splat is brighter at its rim: your d_cov2d has the wrong sign."""

TASKS = ("15.3",)
LOSES = ("15.3.differences", "15.3.hidden")
REPLACE = [("d_S = np.stack(", "d_S = -np.stack(")]
