"""Your conic is the covariance itself: it takes the inverse."""

TASKS = ("15.3",)
LOSES = ("15.3.round", "15.3.ellipse", "15.3.cuts", "15.3.differences", "15.3.hidden")
REPLACE = [
    (
        "A, B, C = (S[:, ::-1] * [1, -1, 1] / det[:, None]).T[:, :, None]",
        "A, B, C = (S + 0 * det[:, None]).T[:, :, None]",
    )
]
