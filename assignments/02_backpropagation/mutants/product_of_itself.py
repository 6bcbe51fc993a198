"""Your product notes the product itself as slope towards both factors."""

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
        "((self, other.data), (other, self.data))",
        "((self, self.data * other.data), (other, self.data * other.data))",
    )
]
