"""Channels are summed, only voxels are averaged."""

TASKS = ("09.4",)
LOSES = ("09.4.values", "09.4.balance", "09.4.hidden")
REPLACE = [("count = grid[..., 0].size", "count = grid.size")]
