"""Your order goes level by level from the root; paths of different length break it."""

TASKS = ("02.4", "02.5")
LOSES = ("02.4.order", "02.5.expressions", "02.5.random")
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
    order, seen = [root], {root}
    for node in order:
        for source, _ in node.inputs:
            if source not in seen:
                seen.add(source)
                order.append(source)
    return order[::-1]
""",
    )
]
