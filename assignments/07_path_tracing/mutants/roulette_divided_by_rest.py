"""Paths that go on are divided by the probability of ending."""

TASKS = ("07.4",)
LOSES = (
    "07.4.hidden",
    "07.4.mean",
)
REPLACE = [
    (
        ("return np.where(alive[:, None], beta / np.where(alive, q, 1.0)[:, None], 0.0), alive"),
        (
            "return np.where(alive[:, None], beta / np.where(alive & (q < 1), 1 - q, "
            "1.0)[:, None], 0.0), alive"
        ),
    ),
]
