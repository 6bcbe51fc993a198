"""The radius of your ring is 1 - z^2: the root is missing."""

TASKS = ("04.4",)
LOSES = ("04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [(("r = np.sqrt(1 - z * z)\n    cap"), ("r = 1 - z * z\n    cap"))]
