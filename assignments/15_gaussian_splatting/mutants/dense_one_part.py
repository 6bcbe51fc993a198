"""A split Gaussian becomes two parts."""

TASKS = ("15.6",)
LOSES = ("15.6.rows", "15.6.values", "15.6.most", "15.6.hidden", "15.6.gain")
REPLACE = [
    (
        "rows = np.concatenate([stay, clone, split, split])",
        "rows = np.concatenate([stay, clone, split, split[:0]])",
    ),
    ("len(rows) - 2 * len(split)", "len(rows) - len(split)"),
    ("standard_normal((2 * len(split), 3))", "standard_normal((len(split), 3))"),
]
