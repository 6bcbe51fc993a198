"""You sort the derivatives once more: what came from row order[k] goes to row order[k]."""

TASKS = ("15.4",)
LOSES = ("15.4.order", "15.4.differences", "15.4.hidden")
REPLACE = [
    (
        "d_alpha[order] = T[:-1] * v - rest / (1 - a)",
        "d_alpha[:] = (T[:-1] * v - rest / (1 - a))[order]",
    )
]
