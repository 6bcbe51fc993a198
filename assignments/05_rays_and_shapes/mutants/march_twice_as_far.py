"""The ray goes twice as far as it may, and through thin things."""

TASKS = ("05.4",)
LOSES = ("05.4.met", "05.4.derivative", "05.4.cost", "05.4.hidden")
REPLACE = [("t[live] += np.abs(distance)", "t[live] += 2 * np.abs(distance)")]
