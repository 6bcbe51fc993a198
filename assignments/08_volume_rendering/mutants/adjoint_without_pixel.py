"""Your d_sigma ignores d_pixel: each channel counts by its own derivative."""

TASKS = ("08.2",)
LOSES = (
    "08.2.differences",
    "08.2.background",
    "08.2.linear",
    "08.2.walls",
    "08.2.hidden",
    "08.2.cost",
)
REPLACE = [
    ("v = np.sum(color[:, k] * d_pixel, axis=1)", "v = np.sum(color[:, k], axis=1)"),
    (
        "left = np.sum(pixel * d_pixel, axis=1) + end * d_T_end",
        "left = np.sum(pixel, axis=1) + end * d_T_end",
    ),
]
