"""Your colours leave 0 to 1."""

TASKS = ("09.6",)
LOSES = ("09.6.first", "09.6.hidden")
REPLACE = [
    (
        "grid[..., :3] = np.clip(grid[..., :3], 0.0, 1.0)",
        "grid[..., :3] = np.clip(grid[..., :3], -9.0, 9.0)",
    )
]
