"""pull sums sizes, not squares."""

TASKS = ("15.3",)
LOSES = ("15.3.pull", "15.3.hidden")
REPLACE = [
    (
        "pull = np.abs(np.stack([gx, gy])).sum(axis=2).T",
        "pull = (np.stack([gx, gy]) ** 2).sum(axis=2).T",
    )
]
