"""Derivatives of rays add up: you divide by their number."""

TASKS = ("08.6",)
LOSES = ("08.6.differences", "08.6.rays", "08.6.hidden")
REPLACE = [
    (
        "d_samples = np.concatenate([back[1], back[0][:, :, None]], axis=2)",
        ("d_samples = np.concatenate([back[1], back[0][:, :, None]], axis=2) / len(origins)"),
    )
]
