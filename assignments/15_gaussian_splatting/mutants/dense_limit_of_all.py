"""Faint ones make room: count those that stay."""

TASKS = ("15.6",)
LOSES = ("15.6.most", "15.6.hidden")
REPLACE = [("max(most - kept.sum(), 0)", "max(most - len(kept), 0)")]
