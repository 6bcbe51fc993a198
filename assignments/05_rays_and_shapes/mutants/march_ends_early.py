"""The march stops a thousandth before the surface."""

TASKS = ("05.4",)
LOSES = ("05.4.met", "05.4.derivative", "05.4.cost", "05.4.hidden")
REPLACE = [("np.abs(distance) < CLOSE", "np.abs(distance) < 1e-3")]
