"""Your sum notes slope -1 towards its second input, which is that of a difference."""

TASKS = ("02.1", "02.5")
LOSES = (
    "02.1.slopes",
    "02.1.square",
    "02.1.many",
    "02.5.worked",
    "02.5.expressions",
    "02.5.random",
)
REPLACE = [("((self, 1.0), (other, 1.0))", "((self, 1.0), (other, -1.0))")]
