"""Channels share a root with you: each has its own."""

TASKS = ("09.4",)
LOSES = ("09.4.values", "09.4.balance", "09.4.hidden")
REPLACE = [
    (
        "length = np.sqrt(eps**2 + np.sum(ahead**2, axis=0))",
        "length = np.sqrt(eps**2 + np.sum(ahead**2, axis=(0, 4), keepdims=True))[0]",
    ),
    ("pull = ahead / length", "pull = ahead / length[None]"),
]
