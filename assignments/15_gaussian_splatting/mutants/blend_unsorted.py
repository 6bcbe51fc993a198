"""You blend in the order of the list: sort by depth."""

TASKS = ("15.4",)
LOSES = ("15.4.layers", "15.4.order", "15.4.hidden")
REPLACE = [('order = np.argsort(depth, kind="stable")', "order = np.arange(len(depth))")]
