"""Your angle covers half a turn."""

TASKS = ("04.4",)
LOSES = ("04.4.chi", "04.4.hidden")
REPLACE = [("phi = 2 * np.pi * u2[:, 1]", "phi = np.pi * u2[:, 1]")]
