"""The densities in the weight are exchanged: the worse strategy gets the weight."""

TASKS = ("07.3",)
LOSES = (
    "07.3.hidden",
    "07.3.matte",
)
REPLACE = [
    (
        ('scale = mis_weight(mine, theirs) * dot(way, hit["normals"]) / np.where(lit, mine, 1.0)'),
        ('scale = mis_weight(theirs, mine) * dot(way, hit["normals"]) / np.where(lit, mine, 1.0)'),
    ),
]
