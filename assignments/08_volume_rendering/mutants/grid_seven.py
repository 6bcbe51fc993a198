"""The corner that lies farther on all three axes has no weight with you."""

TASKS = ("08.4",)
LOSES = ("08.4.products", "08.4.hidden")
REPLACE = [
    (
        "for corner in np.ndindex(2, 2, 2):",
        "for corner in [each for each in np.ndindex(2, 2, 2) if sum(each) < 3]:",
    )
]
