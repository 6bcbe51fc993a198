"""Sum colour times derivative over channels: you multiply the sums."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.background", "08.2.walls", "08.2.hidden", "08.2.cost")
REPLACE = [
    (
        "v = np.sum(color[:, k] * d_pixel, axis=1)",
        "v = np.mean(color[:, k], axis=1) * np.sum(d_pixel, axis=1)",
    )
]
