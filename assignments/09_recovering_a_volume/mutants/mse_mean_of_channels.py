"""Channels are summed, only rays are averaged: you divide by three times too much."""

TASKS = ("09.3",)
LOSES = ("09.3.values", "09.3.hidden")
REPLACE = [
    (
        "return float(np.sum(residual**2) / len(residual)), 2 / len(residual) * residual",
        "return float(np.sum(residual**2) / residual.size), 2 / residual.size * residual",
    )
]
