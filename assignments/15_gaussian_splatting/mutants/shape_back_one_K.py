"""K K holds K twice: your d_K lacks one of the two terms."""

TASKS = ("15.1",)
LOSES = ("15.1.differences", "15.1.hidden")
REPLACE = [("w * d_R - d_R @ K - K @ d_R", "w * d_R - d_R @ K")]
