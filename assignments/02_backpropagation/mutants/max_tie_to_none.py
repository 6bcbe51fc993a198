"""At a tie your maximum gives no slope at all; maximum(x, x) is x and has slope 1."""

TASKS = ("02.2",)
LOSES = ("02.2.tie",)
REPLACE = [
    (
        "return Value(larger, ((self, wins), (other, 1.0 - wins)))",
        "return Value(larger, ((self, wins), (other, 1.0 if other.data > self.data else 0.0)))",
    )
]
