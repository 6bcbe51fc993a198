"""Each strategy counts half, whatever its density: as noisy as the worse one."""

TASKS = ("07.2",)
LOSES = (
    "07.2.extremes",
    "07.2.hidden",
    "07.2.values",
)
REPLACE = [
    (
        "return np.where(pdf > 0, mine / np.where(pdf > 0, mine + theirs, 1.0), 0.0)",
        "return np.where(pdf > 0, 0.5, 0.0)",
    ),
]
