"""All of g goes to the nearest voxel: share it among eight."""

TASKS = ("08.5",)
LOSES = ("08.5.single", "08.5.transpose", "08.5.hidden")
REPLACE = [
    (
        "part = np.prod(np.where(upper, fraction, 1 - fraction), axis=1)",
        "part = np.prod(np.where(upper, fraction >= 0.5, fraction < 0.5), axis=1)",
    )
]
