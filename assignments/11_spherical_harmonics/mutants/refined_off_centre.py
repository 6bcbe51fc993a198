"""Your fine cells lie a quarter of a coarse cell (half a fine one) off: see equation (21)."""

TASKS = ("11.6",)
LOSES = ("11.6.refine", "11.6.hidden")
REPLACE = [
    (
        ("            p = (np.stack(np.indices(fine), axis=-1).reshape(-1, 3) + 0.5) / 2 - 0.5\n"),
        ("            p = (np.stack(np.indices(fine), axis=-1).reshape(-1, 3)) / 2\n"),
    )
]
