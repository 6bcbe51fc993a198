"""Your order leaves out the leaves: values without inputs belong to the graph too."""

TASKS = ("02.4",)
LOSES = ("02.4.order", "02.4.chain", "02.4.work")
REPLACE = [
    (
        """\
            order.append(node)
        elif""",
        """\
            order += [node] if node.inputs else []
        elif""",
    )
]
