"""Things are sorted by their lower corners, not by their middles."""

TASKS = ("05.5",)
LOSES = ("05.5.axis",)
REPLACE = [
    (
        "order[start:stop] = mine[np.argsort(twice_middle[mine, axis])]",
        "order[start:stop] = mine[np.argsort(low[mine, axis])]",
    )
]
