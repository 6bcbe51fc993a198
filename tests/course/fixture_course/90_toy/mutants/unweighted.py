"""Your sum equals the one without the weights."""

TASKS = ("90.1",)
LOSES = ("90.1.value", "90.1.hidden")
REPLACE = [("np.sum(w * np.exp(-x))", "np.sum(np.exp(-x))")]
