"""Total variation counts with the weight TV, in the derivative as well."""

TASKS = ("09.6",)
LOSES = ("09.6.first", "09.6.hidden", "09.6.recovers")
REPLACE = [
    ("grid = adam.step(grid, d_grid + TV * d_rough)", "grid = adam.step(grid, d_grid + d_rough)")
]
