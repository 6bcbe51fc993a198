"""Your weights are exchanged: the nearer voxel gets the larger share."""

TASKS = ("08.5",)
LOSES = ("08.5.single", "08.5.transpose", "08.5.hidden")
REPLACE = [
    (
        "part = np.prod(np.where(upper, fraction, 1 - fraction), axis=1)",
        "part = np.prod(np.where(upper, 1 - fraction, fraction), axis=1)",
    )
]
