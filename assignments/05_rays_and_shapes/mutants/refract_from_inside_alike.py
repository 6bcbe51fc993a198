"""From inside the ratio is the same as from outside; it is 1 / eta there."""

TASKS = ("05.3",)
LOSES = (
    "05.3.snell",
    "05.3.back",
    "05.3.total",
    "05.3.hidden",
)
REPLACE = [
    (
        "ratio = eta**side",
        "ratio = eta * np.ones(side.shape)",
    ),
]
