"""That is the balance heuristic; the power heuristic takes the squares of densities."""

TASKS = ("07.2",)
LOSES = (
    "07.2.extremes",
    "07.2.hidden",
    "07.2.values",
)
REPLACE = [
    (
        "mine, theirs = (pdf / most) ** 2, (other / most) ** 2",
        "mine, theirs = pdf / most, other / most",
    ),
]
