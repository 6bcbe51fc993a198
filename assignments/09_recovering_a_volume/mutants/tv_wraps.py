"""Your last voxel's neighbour is the first one: at the far border there is no difference."""

TASKS = ("09.4",)
LOSES = ("09.4.values", "09.4.hidden")
REPLACE = [
    (
        "np.diff(grid, axis=axis, append=grid.take([-1], axis=axis))",
        "np.roll(grid, -1, axis=axis) - grid",
    )
]
