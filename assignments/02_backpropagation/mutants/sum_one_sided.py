"""Your sum notes its first input only."""

TASKS = ("02.1", "02.5")
LOSES = (
    "02.1.slopes",
    "02.1.square",
    "02.1.many",
    "02.5.worked",
    "02.5.expressions",
    "02.5.random",
)
REPLACE = [
    (
        "return Value(self.data + other.data, ((self, 1.0), (other, 1.0)))",
        "return Value(self.data + other.data, ((self, 1.0),))",
    )
]
