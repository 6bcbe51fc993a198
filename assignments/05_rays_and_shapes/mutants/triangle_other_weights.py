"""The weights are those of a and b; b and c are asked for."""

TASKS = ("05.2",)
LOSES = ("05.2.inside", "05.2.hidden")
REPLACE = [("np.where(met, weights[1:], 0.0).T", "np.where(met, weights[:2], 0.0).T")]
