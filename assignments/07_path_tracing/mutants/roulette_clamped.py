"""1 / q is clamped: what was to make up for the ended paths is lost."""

TASKS = ("07.4",)
LOSES = (
    "07.4.hidden",
    "07.4.mean",
)
REPLACE = [
    (
        ("return np.where(alive[:, None], beta / np.where(alive, q, 1.0)[:, None], 0.0), alive"),
        (
            "return np.where(alive[:, None], beta * np.minimum(1 / np.where(alive, q, "
            "1.0), 2.0)[:, None], 0.0), alive"
        ),
    ),
]
