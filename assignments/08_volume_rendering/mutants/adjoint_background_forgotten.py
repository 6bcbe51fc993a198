"""A step hides the background, too: that part of d_sigma is missing."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.background", "08.2.walls", "08.2.hidden", "08.2.cost")
REPLACE = [
    (
        "left = np.sum(pixel * d_pixel, axis=1) + end * d_T_end",
        ("left = np.sum((pixel - end[:, None] * background) * d_pixel, axis=1) + end * d_T_end"),
    )
]
