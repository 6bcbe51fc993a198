"""Texels without samples must keep their value; yours are overwritten."""

TASKS = ("03.5",)
LOSES = ("03.5.unseen",)
REPLACE = [
    (
        "    return T, losses, weight[:, :, 0] == 0",
        (
            "    T = np.where(weight == 0, T0.mean(axis=(0, 1)), T)\n"
            "    return T, losses, weight[:, :, 0] == 0"
        ),
    )
]
