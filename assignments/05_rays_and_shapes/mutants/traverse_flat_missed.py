"""A box without thickness is missed."""

TASKS = ("05.6",)
LOSES = ("05.6.nearest", "05.6.axes", "05.6.hidden")
REPLACE = [("return near if near <= far else np.inf", "return near if near < far else np.inf")]
