"""Your order is right, but you walk every path: the work doubles with each diamond."""

TASKS = ("02.4",)
LOSES = ("02.4.work",)
REPLACE = [
    (
        """\
            order.append(node)
        elif node not in seen:
            seen.add(node)
""",
        """\
            if node not in seen:
                order.append(node)
            seen.add(node)
        else:
""",
    )
]
