"""Directions are taken to have length 1; t counts in lengths of the direction."""

TASKS = ("05.1",)
LOSES = ("05.1.outside", "05.1.inside", "05.1.misses", "05.1.hidden")
REPLACE = [("square = np.sum(directions**2, axis=1)", "square = np.ones(len(directions))")]
