"""One of the three volumes has its corners in the wrong order, and the wrong sign."""

TASKS = ("05.2",)
LOSES = ("05.2.inside", "05.2.misses", "05.2.edges", "05.2.hidden")
REPLACE = [("np.cross(c, a)", "np.cross(a, c)")]
