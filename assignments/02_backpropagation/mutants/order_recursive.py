"""Your function calls itself, and Python allows a depth of 1000; keep a stack of your own."""

TASKS = ("02.4",)
LOSES = ("02.4.chain",)
REPLACE = [
    (
        """\
    order, seen = [], set()
    stack = [(root, False)]
    while stack:
        node, inputs_done = stack.pop()
        if inputs_done:
            order.append(node)
        elif node not in seen:
            seen.add(node)
            stack.append((node, True))
            for source, _ in node.inputs:
                stack.append((source, False))
    return order
""",
        """\
    order, seen = [], set()

    def visit(node):
        if node not in seen:
            seen.add(node)
            for source, _ in node.inputs:
                visit(source)
            order.append(node)

    visit(root)
    return order
""",
    )
]
