"""The last use of a value overwrites the earlier ones: contributions are added."""

TASKS = ("02.5",)
LOSES = ("02.5.worked", "02.5.adds", "02.5.seed", "02.5.expressions", "02.5.random")
REPLACE = [("source.grad += slope * node.grad", "source.grad = slope * node.grad")]
