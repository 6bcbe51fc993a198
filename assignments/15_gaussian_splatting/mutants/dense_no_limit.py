"""There are more than `most`."""

TASKS = ("15.6",)
LOSES = ("15.6.most", "15.6.hidden")
REPLACE = [("[: max(most - kept.sum(), 0)]", "[: len(rows)]")]
