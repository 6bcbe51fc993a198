"""You keep extinction below 1 as well: only colours have an upper limit."""

TASKS = ("09.6",)
LOSES = ("09.6.first", "09.6.hidden", "09.6.recovers")
REPLACE = [("np.maximum(grid[..., 3], 0.0)", "np.clip(grid[..., 3], 0.0, 1.0)")]
