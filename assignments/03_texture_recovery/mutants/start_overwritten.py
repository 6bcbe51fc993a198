"""T0 itself has changed: copy it first."""

TASKS = ("03.5",)
LOSES = ("03.5.start",)
REPLACE = [("T = T0.copy()", "T = T0"), ("T = T - step * d_T", "T -= step * d_T")]
