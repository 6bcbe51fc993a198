"""Weights are left where nothing is met."""

TASKS = ("05.2",)
LOSES = ("05.2.misses", "05.2.hidden")
REPLACE = [("np.where(met, weights[1:], 0.0).T", "weights[1:].T")]
