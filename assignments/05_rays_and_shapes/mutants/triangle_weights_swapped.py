"""The weights of b and c are exchanged."""

TASKS = ("05.2",)
LOSES = ("05.2.inside", "05.2.hidden")
REPLACE = [("np.where(met, weights[1:], 0.0).T", "np.where(met, weights[:0:-1], 0.0).T")]
