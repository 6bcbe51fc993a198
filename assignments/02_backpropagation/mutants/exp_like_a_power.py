"""Your exponential has the slope of a power, x exp(x - 1)."""

TASKS = ("02.3", "02.5")
LOSES = ("02.3.exp", "02.3.many", "02.5.expressions", "02.5.random")
REPLACE = [
    (
        "return Value(grown, ((self, grown),))",
        "return Value(grown, ((self, self.data * math.exp(self.data - 1.0)),))",
    )
]
