"""The cosine at the surface is missing in the gradient."""

TASKS = ("07.6",)
LOSES = ()
REPLACE = [
    (
        (
            'factor = mis_weight(own, other) * dot(ways, both["normals"]) / '
            "np.where(counts, own, 1.0)"
        ),
        "factor = mis_weight(own, other) / np.where(counts, own, 1.0)",
    ),
]
