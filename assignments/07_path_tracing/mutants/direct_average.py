"""Each strategy counts half: the mean is right, and the noise of the worse one remains."""

TASKS = ("07.3",)
LOSES = ("07.3.hidden", "07.3.matte")
REPLACE = [
    (
        'scale = mis_weight(mine, theirs) * np.sum(way * hit["normals"], axis=1)',
        'scale = 0.5 * np.sum(way * hit["normals"], axis=1)',
    )
]
