"""You sum over voxels: equation (9) takes their mean."""

TASKS = ("09.4",)
LOSES = ("09.4.values", "09.4.hidden")
REPLACE = [("count = grid[..., 0].size", "count = 1")]
