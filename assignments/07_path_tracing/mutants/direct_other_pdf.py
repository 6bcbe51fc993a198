"""A sample is divided by the density of the other strategy."""

TASKS = ("07.3",)
LOSES = (
    "07.3.furnace",
    "07.3.hidden",
    "07.3.matte",
    "07.3.proposal",
)
REPLACE = [
    (
        ('scale = mis_weight(mine, theirs) * dot(way, hit["normals"]) / np.where(lit, mine, 1.0)'),
        (
            'scale = mis_weight(mine, theirs) * dot(way, hit["normals"]) / np.where(lit, '
            "theirs, 1.0)"
        ),
    ),
]
