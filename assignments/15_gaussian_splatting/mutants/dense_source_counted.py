"""source says which row it was before, not which it is now."""

TASKS = ("15.6",)
LOSES = ("15.6.rows", "15.6.most", "15.6.hidden")
REPLACE = [
    (
        "np.where(np.arange(len(rows)) < len(stay), rows, -1)",
        "np.where(np.arange(len(rows)) < len(stay), np.arange(len(rows)), -1)",
    )
]
