"""The weights are missing in the gradient: both strategies count in full."""

TASKS = ("07.6",)
LOSES = ()
REPLACE = [
    (
        (
            'factor = mis_weight(own, other) * dot(ways, both["normals"]) / '
            "np.where(counts, own, 1.0)"
        ),
        'factor = dot(ways, both["normals"]) / np.where(counts, own, 1.0)',
    ),
]
