"""The absolute gradient stands where the signed one belongs, and the other way round."""

TASKS = ("15.3",)
LOSES = ("15.3.differences", "15.3.pull", "15.3.hidden")
REPLACE = [
    (
        "return d_mean2d, d_S, (1 - o) * g.sum(axis=1), pull",
        "return pull, d_S, (1 - o) * g.sum(axis=1), d_mean2d",
    )
]
