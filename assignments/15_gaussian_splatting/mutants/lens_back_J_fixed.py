"""J depends on the mean: your covariance does not pull at it."""

TASKS = ("15.2",)
LOSES = ("15.2.differences", "15.2.held", "15.2.hidden")
REPLACE = [("f * d_mean2d + np.where(h == u, d_h, 0.0)", "f * d_mean2d")]
