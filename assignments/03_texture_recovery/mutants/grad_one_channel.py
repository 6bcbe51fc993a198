"""Your gradient mixes the channels: each has its own residual."""

TASKS = ("03.3",)
LOSES = ("03.3.differences", "03.3.hidden")
REPLACE = [
    (
        "2 * residual / count",
        "2 * residual.mean(axis=1, keepdims=True) * np.ones(target.shape[1]) / count",
    )
]
