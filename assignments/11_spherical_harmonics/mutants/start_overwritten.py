"""You write into an array that you were given: make copies."""

TASKS = ("11.6",)
LOSES = ("11.6.start",)
REPLACE = [
    (
        ("    losses = []\n    for level"),
        (
            "    losses = []\n"
            "    np.maximum(coefficients, -9.0, out=coefficients)\n"
            "    coefficients *= 1.0 - 1e-14\n"
            "    for level"
        ),
    )
]
