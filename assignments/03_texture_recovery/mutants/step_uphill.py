"""Your descent climbs: subtract the gradient."""

TASKS = ("03.5",)
LOSES = ("03.5.step", "03.5.chain", "03.5.recovers")
REPLACE = [("T = T - step * d_T", "T = T + step * d_T")]
