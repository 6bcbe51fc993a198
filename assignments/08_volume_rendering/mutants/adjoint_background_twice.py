"""The pixel's total holds the background already: you count it twice."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.background", "08.2.walls", "08.2.hidden", "08.2.cost")
REPLACE = [
    (
        "left = np.sum(pixel * d_pixel, axis=1) + end * d_T_end",
        (
            "left = np.sum(pixel * d_pixel, axis=1) + end * d_T_end\n"
            "    left = left + end * (d_pixel @ background)"
        ),
    )
]
