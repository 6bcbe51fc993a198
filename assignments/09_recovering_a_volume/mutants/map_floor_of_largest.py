"""Where all derivatives are negative, the largest of them is no scale: take absolute values."""

TASKS = ("09.5",)
LOSES = ("09.5.silent",)
REPLACE = [("FLOOR * np.abs(slope).max()", "FLOOR * slope.max()")]
