"""A negative extinction becomes positive with you: set it to 0."""

TASKS = ("09.6",)
LOSES = ("09.6.first", "09.6.falls", "09.6.hidden")
REPLACE = [("np.maximum(grid[..., 3], 0.0)", "np.abs(grid[..., 3])")]
