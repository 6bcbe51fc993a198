"""The densities are cubed; the power heuristic squares them."""

TASKS = ("07.2",)
LOSES = (
    "07.2.extremes",
    "07.2.hidden",
    "07.2.values",
)
REPLACE = [
    (
        "mine, theirs = (pdf / most) ** 2, (other / most) ** 2",
        "mine, theirs = (pdf / most) ** 3, (other / most) ** 3",
    ),
]
