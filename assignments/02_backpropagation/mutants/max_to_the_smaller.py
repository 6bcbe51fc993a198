"""Your maximum gives the slope to the smaller input."""

TASKS = ("02.2", "02.5")
LOSES = ("02.2.routes", "02.2.tie", "02.2.many", "02.5.worked", "02.5.expressions", "02.5.random")
REPLACE = [
    (
        "return Value(larger, ((self, wins), (other, 1.0 - wins)))",
        "return Value(larger, ((self, 1.0 - wins), (other, wins)))",
    )
]
