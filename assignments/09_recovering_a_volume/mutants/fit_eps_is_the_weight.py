"""SMOOTH is the eps of total variation, TV its weight: you give TV as eps."""

TASKS = ("09.6",)
LOSES = ("09.6.first", "09.6.draws", "09.6.hidden")
REPLACE = [("tv_loss_adjoint(grid, SMOOTH)", "tv_loss_adjoint(grid, TV)")]
