"""Only the nearer of two children is looked at."""

TASKS = ("05.6",)
LOSES = ("05.6.nearest", "05.6.axes", "05.6.growth", "05.6.embree", "05.6.hidden")
REPLACE = [("todo += sorted(children, reverse=True)", "todo.append(min(children))")]
