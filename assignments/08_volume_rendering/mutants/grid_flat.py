"""You take the nearest layer along z: mix both."""

TASKS = ("08.4",)
LOSES = ("08.4.products", "08.4.hidden")
REPLACE = [
    (
        "share = np.prod(np.where(corner, f, 1 - f), axis=1)",
        (
            "share = np.prod(np.where(corner, [1, 1, 0] * f + [0, 0, 1] * (f >= 0.5), 1 "
            "- ([1, 1, 0] * f + [0, 0, 1] * (f >= 0.5))), axis=1)"
        ),
    )
]
