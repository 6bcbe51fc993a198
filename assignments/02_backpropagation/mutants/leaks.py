"""Gradients of the previous call are still there: set all values of the graph to zero first."""

TASKS = ("02.5",)
LOSES = ("02.5.again",)
REPLACE = [
    (
        """\
        node.grad = 0.0
""",
        """\
        node.grad += 0.0
""",
    )
]
