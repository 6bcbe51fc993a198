"""Every box counts as entered."""

TASKS = ("05.6",)
LOSES = ("05.6.cost", "05.6.growth", "05.6.hidden")
REPLACE = [("return near if near <= far else np.inf", "return 0.0")]
