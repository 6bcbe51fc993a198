"""A value that uses the same input twice passes its gradient on only once."""

TASKS = ("02.5",)
LOSES = ("02.5.worked", "02.5.adds")
REPLACE = [
    (
        """\
for source, slope in node.inputs:
            source.grad""",
        """\
for source, slope in dict(node.inputs).items():
            source.grad""",
    )
]
