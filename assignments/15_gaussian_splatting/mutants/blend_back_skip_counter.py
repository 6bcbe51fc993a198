"""You go through as many rows as a pixel has seen splats: unseen ones lie in between."""

TASKS = ("15.4",)
LOSES = ("15.4.differences", "15.4.hidden")
REPLACE = [
    (
        "d_alpha[order] = T[:-1] * v - rest / (1 - a)",
        (
            "d_alpha[order] = np.where(np.cumsum(a > -1, axis=0) <= (a > 0).sum(axis=0), "
            "T[:-1] * v - rest / (1 - a), 0.0)"
        ),
    )
]
