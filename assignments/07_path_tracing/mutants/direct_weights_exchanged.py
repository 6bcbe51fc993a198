"""The densities in the weight are exchanged: the worse strategy gets the weight."""

TASKS = ("07.3",)
LOSES = ("07.3.hidden", "07.3.matte")
REPLACE = [
    (
        'scale = mis_weight(mine, theirs) * np.sum(way * hit["normals"], axis=1)',
        'scale = mis_weight(theirs, mine) * np.sum(way * hit["normals"], axis=1)',
    )
]
