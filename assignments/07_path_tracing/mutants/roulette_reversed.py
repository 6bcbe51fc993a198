"""Paths end with probability q; they should go on with it."""

TASKS = ("07.4",)
LOSES = ("07.4.ends", "07.4.hidden", "07.4.mean", "07.4.values")
REPLACE = [("alive = u < q", "alive = u >= q")]
