"""Your terms grow with x: the exponent lacks its minus sign."""

TASKS = ("90.1",)
LOSES = ("90.1.value", "90.1.hidden")
REPLACE = [("w * np.exp(-x)))", "w * np.exp(x)))")]
