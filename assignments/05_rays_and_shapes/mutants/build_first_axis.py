"""All cuts are across x."""

TASKS = ("05.5",)
LOSES = ("05.5.axis", "05.5.hidden")
REPLACE = [("axis = np.ptp(twice_middle[mine], axis=0).argmax()", "axis = 0")]
