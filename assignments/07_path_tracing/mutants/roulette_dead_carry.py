"""Paths that have ended keep their factors."""

TASKS = ("07.4",)
LOSES = (
    "07.4.hidden",
    "07.4.mean",
    "07.4.values",
)
REPLACE = [
    (
        ("return np.where(alive[:, None], beta / np.where(alive, q, 1.0)[:, None], 0.0), alive"),
        "return beta / np.where(alive, q, 1.0)[:, None], alive",
    ),
]
