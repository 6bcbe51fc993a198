"""You set negative extinction to 0 after the last step only: on the way it amplifies light."""

TASKS = ("09.6",)
LOSES = ("09.6.first", "09.6.draws", "09.6.hidden", "09.6.recovers")
REPLACE = [
    (
        "grid[..., 3] = np.maximum(grid[..., 3], 0.0)",
        "grid[..., 3] = np.maximum(grid[..., 3], 0.0 if step == steps - 1 else -np.inf)",
    )
]
