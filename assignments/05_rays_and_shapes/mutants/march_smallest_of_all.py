"""All rays go ahead by the smallest distance of all."""

TASKS = ("05.4",)
LOSES = ("05.4.cost", "05.4.hidden")
REPLACE = [("t[live] += np.abs(distance)", "t[live] += np.abs(distance).min()")]
