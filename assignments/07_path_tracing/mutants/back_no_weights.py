"""The weights are missing in the gradient: both strategies count in full."""

TASKS = ("07.6",)
LOSES = ("07.6.cost", "07.6.differences", "07.6.hidden", "07.6.mean")
REPLACE = [
    (
        'factor = mis_weight(own, other) * np.sum(ways * both["normals"], axis=1)',
        'factor = np.sum(ways * both["normals"], axis=1)',
    )
]
