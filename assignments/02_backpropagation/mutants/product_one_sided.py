"""Your product notes only its first factor."""

TASKS = ("02.1", "02.5")
LOSES = (
    "02.1.slopes",
    "02.1.square",
    "02.1.many",
    "02.5.worked",
    "02.5.expressions",
    "02.5.random",
)
REPLACE = [("((self, other.data), (other, self.data))", "((self, other.data),)")]
