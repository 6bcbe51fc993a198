"""You multiply the slope by the user's number; it has to be the user's gradient."""

TASKS = ("02.5",)
LOSES = ("02.5.worked", "02.5.adds", "02.5.seed", "02.5.expressions", "02.5.random", "02.5.chain")
REPLACE = [("slope * node.grad", "slope * node.data * root.grad")]
