"""The ratio is eta for light from inside as well; there it is 1 / eta."""

TASKS = ("05.3",)
LOSES = ("05.3.snell", "05.3.back", "05.3.total", "05.3.hidden")
REPLACE = [("ratio = eta**side", "ratio = eta * np.ones(side.shape)")]
