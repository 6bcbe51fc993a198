"""Your product notes slopes of 1, which are those of a sum."""

TASKS = ("02.1", "02.5")
LOSES = (
    "02.1.slopes",
    "02.1.square",
    "02.1.many",
    "02.5.worked",
    "02.5.expressions",
    "02.5.random",
)
REPLACE = [("((self, other.data), (other, self.data))", "((self, 1.0), (other, 1.0))")]
