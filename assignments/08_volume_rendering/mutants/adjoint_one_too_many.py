"""What lies directly behind a step is hidden by it, too: you leave one step out."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.background", "08.2.walls", "08.2.hidden", "08.2.cost")
REPLACE = [
    (
        (
            "        left = left - weight * v\n"
            "        d_sigma[:, k] = dt[:, k] * (after * v - left)\n"
        ),
        (
            "        left = left - weight * v\n"
            "        d_sigma[:, k] = dt[:, k] * (after * v - left)\n"
            "        if k + 1 < sigma.shape[1]:\n"
            "            ahead = np.sum(color[:, k + 1] * d_pixel, axis=1)\n"
            "            ahead = ahead * after * -np.expm1(-sigma[:, k + 1] * dt[:, k + "
            "1])\n"
            "            d_sigma[:, k] += dt[:, k] * ahead\n"
        ),
    )
]
