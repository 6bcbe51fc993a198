"""You count a step's own light among what it hides: subtract it before you use the rest."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.background", "08.2.walls", "08.2.hidden", "08.2.cost")
REPLACE = [
    (
        (
            "        left = left - weight * v\n"
            "        d_sigma[:, k] = dt[:, k] * (after * v - left)\n"
        ),
        (
            "        d_sigma[:, k] = dt[:, k] * (after * v - left)\n"
            "        left = left - weight * v\n"
        ),
    )
]
