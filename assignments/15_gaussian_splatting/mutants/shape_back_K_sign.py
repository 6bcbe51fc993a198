"""The transpose of K is -K: mind the sign of what comes from K K."""

TASKS = ("15.1",)
LOSES = ("15.1.differences", "15.1.hidden")
REPLACE = [("w * d_R - d_R @ K - K @ d_R", "w * d_R + d_R @ K + K @ d_R")]
