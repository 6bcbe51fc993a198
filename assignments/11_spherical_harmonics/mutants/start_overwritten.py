"""You write into an array that you were given: make copies."""

TASKS = ("11.6",)
LOSES = ("11.6.start",)
REPLACE = [
    ("    losses = []\n    for level", "    losses, start = [], coefficients\n    for level"),
    (
        "    return density, coefficients, np.array(losses)",
        (
            "    if start is not coefficients:\n"
            "        start *= 0.5\n"
            "    return density, coefficients, np.array(losses)"
        ),
    ),
]
