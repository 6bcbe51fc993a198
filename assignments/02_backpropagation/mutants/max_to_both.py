"""Your maximum gives slope 1 to both inputs; the smaller one does not move the result."""

TASKS = ("02.2", "02.5")
LOSES = ("02.2.routes", "02.2.tie", "02.2.many", "02.5.worked", "02.5.expressions", "02.5.random")
REPLACE = [
    (
        "return Value(larger, ((self, wins), (other, 1.0 - wins)))",
        "return Value(larger, ((self, 1.0), (other, 1.0)))",
    )
]
