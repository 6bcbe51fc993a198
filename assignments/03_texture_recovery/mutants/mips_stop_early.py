"""Your pyramid stops at the shorter side: the last level is a single texel."""

TASKS = ("03.6",)
LOSES = ("03.6.mean", "03.6.spot", "03.6.hidden")
REPLACE = [("while levels[-1].shape[:2] != (1, 1):", "while min(levels[-1].shape[:2]) > 1:")]
