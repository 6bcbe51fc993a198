"""d_color is the step's weight times d_pixel: yours forgets what stands before it."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.linear", "08.2.walls", "08.2.hidden", "08.2.cost")
REPLACE = [
    (
        "d_color[:, k] = weight[:, None] * d_pixel",
        "d_color[:, k] = -np.expm1(-tau)[:, None] * d_pixel",
    )
]
