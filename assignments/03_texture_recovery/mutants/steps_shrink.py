"""Your steps get shorter: the length stays the same from first to last."""

TASKS = ("03.5",)
LOSES = ("03.5.chain",)
REPLACE = [("T = T - step * d_T", "T = T - step / (1 + 0.1 * k) * d_T")]
