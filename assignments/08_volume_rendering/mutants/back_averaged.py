"""You divide by the sum of weights: an adjoint adds up, it does not average."""

TASKS = ("08.5",)
LOSES = ("08.5.single", "08.5.transpose", "08.5.repeated", "08.5.hidden")
REPLACE = [
    (
        "    return d_grid\n",
        (
            "    total = np.zeros((*shape, 1))\n"
            "    for upper in np.ndindex(2, 2, 2):\n"
            "        a, b, c = np.where(upper, ceiling, floor).T\n"
            "        part = np.prod(np.where(upper, fraction, 1 - fraction), axis=1)\n"
            "        np.add.at(total, (a, b, c), part[:, None])\n"
            "    return d_grid / np.where(total > 0, total, 1)\n"
        ),
    )
]
