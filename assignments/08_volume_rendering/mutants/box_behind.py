"""t starts at 0: what lies before that is behind the camera."""

TASKS = ("08.3",)
LOSES = ("08.3.inside", "08.3.hidden")
REPLACE = [("t_near = np.maximum(enter.max(axis=1), 0.0)", "t_near = enter.max(axis=1)")]
