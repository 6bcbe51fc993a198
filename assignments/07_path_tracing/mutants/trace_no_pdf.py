"""The direction in which a path goes on is not divided by its density."""

TASKS = ("07.5",)
LOSES = ("07.5.corner", "07.5.furnace", "07.5.hidden")
REPLACE = [("share = np.divide(cos, pdf, out=np.zeros(len(pdf)), where=pdf > 0)", "share = cos")]
