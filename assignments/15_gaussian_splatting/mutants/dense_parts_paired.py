"""First all first parts, then all second ones: yours stand in pairs."""

TASKS = ("15.6",)
LOSES = ("15.6.rows", "15.6.values", "15.6.hidden")
REPLACE = [
    (
        "rows = np.concatenate([stay, clone, split, split])",
        "rows = np.concatenate([stay, clone, np.repeat(split, 2)])",
    )
]
