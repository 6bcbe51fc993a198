"""d_colors comes back in the sorted order: undo it."""

TASKS = ("15.4",)
LOSES = ("15.4.order", "15.4.differences", "15.4.hidden")
REPLACE = [("d_colors[order] = ", "d_colors[:] = ")]
