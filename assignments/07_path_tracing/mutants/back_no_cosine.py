"""The cosine at the surface is missing in the gradient."""

TASKS = ("07.6",)
LOSES = ("07.6.cost", "07.6.differences", "07.6.hidden", "07.6.mean")
REPLACE = [
    (
        'factor = mis_weight(own, other) * np.sum(ways * both["normals"], axis=1)',
        "factor = mis_weight(own, other)",
    )
]
