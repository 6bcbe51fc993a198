"""Opacities do not add: two of a / 2 let through (1 - a / 2)^2."""

TASKS = ("15.6",)
LOSES = ("15.6.values", "15.6.hidden")
REPLACE = [
    (
        "logits[clone] = np.log(np.sqrt(1 + np.exp(logits[clone])) - 1)",
        "logits[clone] = np.log(opacity[clone] / (2 - opacity[clone]))",
    )
]
