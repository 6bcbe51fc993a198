"""The ray goes on in equal steps; the distance says how far it may go."""

TASKS = ("05.4",)
LOSES = ("05.4.met", "05.4.derivative", "05.4.cost", "05.4.hidden")
REPLACE = [("t[live] += np.abs(distance)", "t[live] += 0.05")]
