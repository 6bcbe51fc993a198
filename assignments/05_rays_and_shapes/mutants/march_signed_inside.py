"""Inside the distance is below 0, and the ray goes backwards."""

TASKS = ("05.4",)
LOSES = ("05.4.met", "05.4.hidden")
REPLACE = [("t[live] += np.abs(distance)", "t[live] += distance")]
