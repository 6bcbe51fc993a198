"""d_mean2d goes by the conic times (dx, dy), not by (dx, dy)."""

TASKS = ("15.3",)
LOSES = ("15.3.differences", "15.3.pull", "15.3.hidden")
REPLACE = [("d_mean2d = -np.stack([gx, gy])", "d_mean2d = -np.stack([g * dx, g * dy])")]
