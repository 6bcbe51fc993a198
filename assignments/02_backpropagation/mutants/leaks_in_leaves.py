"""Leaves keep the gradients of the previous call: they have to start from zero too."""

TASKS = ("02.5",)
LOSES = ("02.5.again",)
REPLACE = [
    (
        """\
        node.grad = 0.0
""",
        """\
        node.grad = 0.0 if node.inputs else node.grad
""",
    )
]
