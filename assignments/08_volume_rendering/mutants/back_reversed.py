"""x goes with the first index, z with the third: yours are reversed."""

TASKS = ("08.5",)
LOSES = ("08.5.single", "08.5.transpose", "08.5.hidden")
REPLACE = [
    (
        "where = np.clip(sizes * u - 0.5, 0, sizes - 1)",
        "where = np.clip(sizes * u[:, ::-1] - 0.5, 0, sizes - 1)",
    )
]
