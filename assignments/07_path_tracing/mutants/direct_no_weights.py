"""Both strategies count in full: the light is counted twice."""

TASKS = ("07.3",)
LOSES = ("07.3.furnace", "07.3.hidden", "07.3.matte", "07.3.proposal")
REPLACE = [
    (
        'scale = mis_weight(mine, theirs) * np.sum(way * hit["normals"], axis=1)',
        'scale = np.sum(way * hit["normals"], axis=1)',
    )
]
