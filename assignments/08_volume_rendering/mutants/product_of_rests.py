"""Your T is the product of 1 - sigma dt: that is only its beginning; exp(-sigma dt) is exact."""

TASKS = ("08.1",)
LOSES = (
    "08.1.constant",
    "08.1.slabs",
    "08.1.weights",
    "08.1.split",
    "08.1.extremes",
    "08.1.order",
    "08.1.hidden",
)
REPLACE = [
    (
        "    w = np.exp(-front)",
        (
            "    rest = np.concatenate([np.ones((len(s), 1)), np.cumprod(1 - s, "
            "axis=1)[:, :-1]], axis=1)\n"
            "    w = rest"
        ),
    )
]
