"""Of equal depth the row that comes first is in front."""

TASKS = ("15.4",)
LOSES = ("15.4.layers", "15.4.hidden")
REPLACE = [
    (
        'order = np.argsort(depth, kind="stable")',
        "order = np.lexsort((-np.arange(len(depth)), depth))",
    )
]
