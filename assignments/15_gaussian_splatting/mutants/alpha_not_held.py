"""Alpha never exceeds ALPHA_MAX."""

TASKS = ("15.3",)
LOSES = ("15.3.cuts", "15.3.differences", "15.3.hidden")
REPLACE = [("np.minimum(raw, ALPHA_MAX)", "np.minimum(raw, 1.0)")]
