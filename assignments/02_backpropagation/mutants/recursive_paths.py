"""You follow each path by calls of calls: right in small graphs, too deep in long ones."""

TASKS = ("02.5",)
LOSES = ("02.5.chain",)
REPLACE = [
    (
        """\
    for node in reversed(order):
        for source, slope in node.inputs:
            source.grad += slope * node.grad
""",
        """\

    def push(node, gradient):
        for source, slope in node.inputs:
            source.grad += slope * gradient
            push(source, slope * gradient)

    push(root, root.grad)
""",
    )
]
