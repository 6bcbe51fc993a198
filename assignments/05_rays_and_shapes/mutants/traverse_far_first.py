"""The farther child is visited first."""

TASKS = ("05.6",)
LOSES = ("05.6.cost", "05.6.hidden")
REPLACE = [("sorted(children, reverse=True)", "sorted(children)")]
