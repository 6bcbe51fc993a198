"""t_far is counted from the origin, too: yours is the length of the stretch inside."""

TASKS = ("08.3",)
LOSES = ("08.3.axes", "08.3.faces", "08.3.parallel", "08.3.hidden")
REPLACE = [("np.where(hit, t_far, 0.0)", "np.where(hit, t_far - t_near, 0.0)")]
