"""You take one step less than asked."""

TASKS = ("03.5",)
LOSES = ("03.5.step", "03.5.chain")
REPLACE = [("T = T - step * d_T", "T = T - step * d_T * (k + 1 < n)")]
