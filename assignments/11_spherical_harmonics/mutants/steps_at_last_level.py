"""You step only at the finest level."""

TASKS = ("11.6",)
LOSES = ("11.6.chain", "11.6.hidden", "11.6.gain")
REPLACE = [
    (
        ("        for _ in range(steps):\n"),
        (
            "        losses += [0.0] * steps if level < levels - 1 else []\n"
            "        for _ in range(steps if level == levels - 1 else 0):\n"
        ),
    )
]
