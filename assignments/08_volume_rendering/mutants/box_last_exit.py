"""A ray is outside once it has left on one axis: take the first exit, not the last."""

TASKS = ("08.3",)
LOSES = ("08.3.faces", "08.3.inside", "08.3.hidden")
REPLACE = [("t_far = leave.min(axis=1)", "t_far = np.where(parallel, 0.0, leave).max(axis=1)")]
