"""dx is the mean minus the pixel: your d_mean2d has the wrong sign."""

TASKS = ("15.3",)
LOSES = ("15.3.differences", "15.3.hidden")
REPLACE = [("d_mean2d = -np.stack", "d_mean2d = np.stack")]
