"""Of equal depth the row that comes first is in front: a sort that is not stable mixes them."""

TASKS = ("15.4",)
LOSES = ("15.4.layers", "15.4.hidden")
REPLACE = [
    (
        'order = np.argsort(depth, kind="stable")',
        # Up to 16 rows such sorts look stable; which rows they exchange depends on the machine.
        "n = np.arange(len(depth))\n    order = np.lexsort((-n if len(n) > 16 else n, depth))",
    )
]
