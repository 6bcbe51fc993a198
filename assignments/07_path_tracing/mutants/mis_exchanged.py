"""The two densities are exchanged: the strategy that fits worse gets the weight."""

TASKS = ("07.2",)
LOSES = (
    "07.2.extremes",
    "07.2.hidden",
    "07.2.values",
)
REPLACE = [
    (
        "return np.where(pdf > 0, mine / np.where(pdf > 0, mine + theirs, 1.0), 0.0)",
        "return np.where(pdf > 0, theirs / np.where(pdf > 0, mine + theirs, 1.0), 0.0)",
    ),
]
