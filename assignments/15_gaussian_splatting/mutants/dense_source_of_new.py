"""What is new has no row before: -1."""

TASKS = ("15.6",)
LOSES = ("15.6.rows", "15.6.most", "15.6.hidden")
REPLACE = [
    (
        "np.where(np.arange(len(rows)) < len(stay), rows, -1)",
        "np.where(np.arange(len(rows)) >= 0, rows, -1)",
    )
]
