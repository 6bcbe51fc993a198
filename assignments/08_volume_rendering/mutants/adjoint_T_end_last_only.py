"""T_end depends on every sigma, not on the last alone."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.background", "08.2.walls", "08.2.hidden", "08.2.cost")
REPLACE = [
    (
        "left = np.sum(pixel * d_pixel, axis=1) + end * d_T_end",
        "left = np.sum(pixel * d_pixel, axis=1)",
    ),
    (
        "return d_sigma, d_color, T @ d_pixel",
        ("d_sigma[:, -1] -= dt[:, -1] * end * d_T_end\n    return d_sigma, d_color, T @ d_pixel"),
    ),
]
