"""A value that is used twice stands in your order twice; remember what you have seen."""

TASKS = ("02.4", "02.5")
LOSES = ("02.4.order", "02.4.work", "02.5.expressions", "02.5.random")
REPLACE = [
    (
        """\
            seen.add(node)
""",
        "",
    )
]
