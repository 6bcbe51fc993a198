"""Your extinction becomes negative: such a medium would amplify light."""

TASKS = ("09.6",)
LOSES = ("09.6.first", "09.6.falls", "09.6.hidden", "09.6.recovers")
REPLACE = [("np.maximum(grid[..., 3], 0.0)", "np.maximum(grid[..., 3], -9.0)")]
