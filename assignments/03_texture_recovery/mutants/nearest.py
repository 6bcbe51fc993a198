"""You take the nearest texel instead of four."""

TASKS = ("03.1",)
LOSES = ("03.1.ramp", "03.1.product", "03.1.hidden")
REPLACE = [
    (
        "s, t = (x - left)[:, None], (y - top)[:, None]",
        "s, t = np.rint(x - left)[:, None], np.rint(y - top)[:, None]",
    )
]
