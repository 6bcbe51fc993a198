"""Your maximum notes the larger number as slope; the slope of a copy is 1."""

TASKS = ("02.2", "02.5")
LOSES = ("02.2.routes", "02.2.tie", "02.2.many", "02.5.worked", "02.5.expressions", "02.5.random")
REPLACE = [
    (
        "return Value(larger, ((self, wins), (other, 1.0 - wins)))",
        "return Value(larger, ((self, wins * larger), (other, (1.0 - wins) * larger)))",
    )
]
