"""Your scales are variances: M has standard deviations, cov their squares."""

TASKS = ("15.1",)
LOSES = ("15.1.axes", "15.1.same", "15.1.differences", "15.1.hidden")
REPLACE = [("s = np.exp(log_scales)[:, None]", "s = np.exp(0.5 * log_scales)[:, None]")]
