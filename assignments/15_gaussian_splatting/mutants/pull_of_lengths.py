"""x and y have a pull each: you sum lengths of both."""

TASKS = ("15.3",)
LOSES = ("15.3.pull", "15.3.hidden")
REPLACE = [
    (
        "pull = np.abs(np.stack([gx, gy])).sum(axis=2).T",
        "pull = np.repeat(np.hypot(gx, gy).sum(axis=1)[:, None], 2, axis=1)",
    )
]
