"""Your order puts a value before its inputs: append it once they are done."""

TASKS = ("02.4", "02.5")
LOSES = ("02.4.order", "02.4.chain", "02.4.work", "02.5.worked", "02.5.expressions", "02.5.random")
REPLACE = [
    (
        """\
            seen.add(node)
            stack.append((node, True))""",
        """\
            seen.add(node)
            order.append(node)""",
    )
]
