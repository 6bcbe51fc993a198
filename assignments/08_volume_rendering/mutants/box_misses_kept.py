"""A ray that misses the box gets (0, 0)."""

TASKS = ("08.3",)
LOSES = ("08.3.inside", "08.3.hidden")
REPLACE = [("hit = t_near < t_far", "hit = np.isfinite(t_near) & np.isfinite(t_far)")]
