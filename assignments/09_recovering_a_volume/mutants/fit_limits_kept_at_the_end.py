"""You go back to what can exist after the last step only: do so in each step."""

TASKS = ("09.6",)
LOSES = ("09.6.first", "09.6.draws", "09.6.hidden", "09.6.recovers")
REPLACE = [
    (
        "grid[..., :3] = np.clip(grid[..., :3], 0.0, 1.0)",
        (
            "near = 0.0 if step == steps - 1 else np.inf\n"
            "        grid[..., :3] = np.clip(grid[..., :3], -near, 1.0 + near)"
        ),
    ),
    (
        "grid[..., 3] = np.maximum(grid[..., 3], 0.0)",
        "grid[..., 3] = np.maximum(grid[..., 3], -near)",
    ),
]
