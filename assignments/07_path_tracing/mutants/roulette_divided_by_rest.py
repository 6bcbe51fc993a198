"""Paths that go on are divided by the probability of ending."""

TASKS = ("07.4",)
LOSES = ("07.4.hidden", "07.4.mean", "07.4.values")
REPLACE = [
    (
        "after[alive] = beta[alive] / q[alive, None]",
        "after[alive] = beta[alive] / np.where(q < 1, 1 - q, 1.0)[alive, None]",
    )
]
