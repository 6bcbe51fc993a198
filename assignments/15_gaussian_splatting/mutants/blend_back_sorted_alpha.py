"""d_alpha comes back in the sorted order: undo it."""

TASKS = ("15.4",)
LOSES = ("15.4.order", "15.4.differences", "15.4.hidden")
REPLACE = [("d_alpha[order] = ", "d_alpha[:] = ")]
