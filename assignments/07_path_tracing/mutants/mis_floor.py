"""A small number in the divisor moves all weights: they do not sum to 1."""

TASKS = ("07.2",)
LOSES = (
    "07.2.extremes",
    "07.2.hidden",
    "07.2.sum",
    "07.2.values",
)
REPLACE = [
    (
        "return np.where(pdf > 0, mine / np.where(pdf > 0, mine + theirs, 1.0), 0.0)",
        "return np.where(pdf > 0, mine / (mine + theirs + 0.01), 0.0)",
    ),
]
