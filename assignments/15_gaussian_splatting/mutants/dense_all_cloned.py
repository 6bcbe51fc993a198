"""Large ones are split, not cloned."""

TASKS = ("15.6",)
LOSES = ("15.6.rows", "15.6.values", "15.6.most", "15.6.hidden")
REPLACE = [(".max(axis=1) <= SMALL", ".max(axis=1) <= np.inf")]
