"""You divide T by 1 - alpha of the row before, whether the pixel saw it or not."""

TASKS = ("15.4",)
LOSES = ("15.4.differences", "15.4.hidden")
REPLACE = [
    (
        "d_alpha[order] = T[:-1] * v - rest / (1 - a)",
        "d_alpha[order] = T[:-1] * v - rest / (1 - np.roll(a, 1, axis=0))",
    )
]
