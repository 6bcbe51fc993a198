"""The squares of large distances are subtracted; from far away nothing is left of the radius."""

TASKS = ("05.1",)
LOSES = ("05.1.far",)
REPLACE = [
    (
        "rest = (radius**2 - np.sum(aside**2, axis=1)) / square",
        "rest = nearest**2 - (np.sum(offset**2, axis=1) - radius**2) / square",
    )
]
