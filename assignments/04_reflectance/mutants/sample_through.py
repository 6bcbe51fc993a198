"""Your directions go through the surface: the sign of the mirrored direction is wrong."""

TASKS = ("04.4",)
LOSES = ("04.4.mirror", "04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [
    (
        "return 2 * np.sum(wo * h, axis=1, keepdims=True) * h - wo",
        "return wo - 2 * np.sum(wo * h, axis=1, keepdims=True) * h",
    )
]
