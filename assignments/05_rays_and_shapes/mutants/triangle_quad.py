"""The edge from b to c is open: the weight of a may be below 0."""

TASKS = ("05.2",)
LOSES = ("05.2.misses", "05.2.edges", "05.2.hidden")
REPLACE = [
    (
        "inside = ((volumes >= 0).all(axis=0) | (volumes <= 0).all(axis=0)) & (whole != 0)",
        "inside = (volumes[1:] * np.sign(whole) >= 0).all(axis=0) & (whole != 0)",
    )
]
