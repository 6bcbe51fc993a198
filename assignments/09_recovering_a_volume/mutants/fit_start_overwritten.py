"""You write into the array that you were given: steps make new ones."""

TASKS = ("09.6",)
LOSES = ("09.6.start",)
REPLACE = [
    (
        "grid = adam.step(grid, d_grid + TV * d_rough)",
        "grid[:] = adam.step(grid, d_grid + TV * d_rough)",
    )
]
