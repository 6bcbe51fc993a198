"""Things are cut in the order in which they came."""

TASKS = ("05.5",)
LOSES = ("05.5.axis", "05.5.hidden")
REPLACE = [
    ("order[start:stop] = mine[np.argsort(twice_middle[mine, axis])]", "order[start:stop] = mine")
]
