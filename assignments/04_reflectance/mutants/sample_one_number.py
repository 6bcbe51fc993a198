"""You use one number for both the height and the angle."""

TASKS = ("04.4",)
LOSES = ("04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [("phi = 2 * np.pi * u2[:, 1]", "phi = 2 * np.pi * u2[:, 0]")]
