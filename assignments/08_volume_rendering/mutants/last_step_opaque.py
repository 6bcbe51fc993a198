"""Your last step is opaque: it ends where dt says, and the background lies behind it."""

TASKS = ("08.1",)
LOSES = ("08.1.constant", "08.1.slabs", "08.1.extremes", "08.1.order", "08.1.hidden")
REPLACE = [
    (
        "T_end = np.exp(-behind[:, -1])",
        (
            "T_end = np.exp(-behind[:, -1])\n"
            "    w[:, -1] = np.exp(-front[:, -1])\n"
            "    T_end = 0 * T_end"
        ),
    )
]
