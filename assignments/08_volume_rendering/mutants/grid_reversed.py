"""x goes with the first index, z with the third: yours are reversed."""

TASKS = ("08.4",)
LOSES = ("08.4.centres", "08.4.products", "08.4.edge", "08.4.hidden")
REPLACE = [
    (
        "place = np.clip(u * counts - 0.5, 0, counts - 1)",
        "place = np.clip(u[:, ::-1] * counts - 0.5, 0, counts - 1)",
    )
]
