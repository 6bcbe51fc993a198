"""The distance takes the place of t instead of being added to it."""

TASKS = ("05.4",)
LOSES = ("05.4.met", "05.4.derivative", "05.4.cost", "05.4.hidden")
REPLACE = [("t[live] += np.abs(distance)", "t[live] = np.abs(distance)")]
