"""Paths that have ended keep their factors."""

TASKS = ("07.4",)
LOSES = ("07.4.hidden", "07.4.mean", "07.4.values")
REPLACE = [("after = np.zeros(beta.shape)", "after = beta.copy()")]
