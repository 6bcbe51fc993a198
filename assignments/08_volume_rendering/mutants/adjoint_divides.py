"""You divide by exp(-sigma dt) to get back to T: behind a wall that is 0 / 0."""

TASKS = ("08.2",)
LOSES = ("08.2.walls",)
REPLACE = [
    ("    T = np.ones(len(sigma))\n", "    total, T = 0.0 * left, end\n"),
    ("for k in range(sigma.shape[1]):", "for k in reversed(range(sigma.shape[1])):"),
    (
        "weight, after = T * -np.expm1(-tau), T * np.exp(-tau)",
        ("after = T\n        T = T / np.exp(-tau)\n        weight = T * -np.expm1(-tau)"),
    ),
    (
        (
            "        left = left - weight * v\n"
            "        d_sigma[:, k] = dt[:, k] * (after * v - left)\n"
        ),
        (
            "        rest = end * (d_pixel @ background + d_T_end)\n"
            "        d_sigma[:, k] = dt[:, k] * (after * v - total - rest)\n"
            "        total = total + weight * v\n"
        ),
    ),
    ("        T = after\n", ""),
    ("return d_sigma, d_color, T @ d_pixel", "return d_sigma, d_color, end @ d_pixel"),
]
