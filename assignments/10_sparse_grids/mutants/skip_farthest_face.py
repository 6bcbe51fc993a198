"""The ray leaves through the first face that it meets, not the last."""

TASKS = ("10.2",)
LOSES = ("10.2.samples", "10.2.cost", "10.2.hidden")
REPLACE = [("ahead.min(axis=1)", "np.where(step == 0, -np.inf, ahead).max(axis=1)")]
