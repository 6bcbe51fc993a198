"""1 / q is clamped for dark paths: what was to make up for the ended ones is lost."""

TASKS = ("07.4",)
LOSES = ("07.4.hidden", "07.4.values")
REPLACE = [
    (
        "after[alive] = beta[alive] / q[alive, None]",
        "after[alive] = beta[alive] * np.minimum(1 / q[alive, None], 10.0)",
    )
]
