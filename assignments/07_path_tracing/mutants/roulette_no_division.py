"""Paths that go on are not multiplied by 1 / q: the picture gets darker."""

TASKS = ("07.4",)
LOSES = (
    "07.4.hidden",
    "07.4.mean",
    "07.4.values",
)
REPLACE = [
    (
        ("return np.where(alive[:, None], beta / np.where(alive, q, 1.0)[:, None], 0.0), alive"),
        "return np.where(alive[:, None], beta, 0.0), alive",
    ),
]
