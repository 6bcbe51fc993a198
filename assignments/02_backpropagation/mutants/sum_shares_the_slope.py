"""Your sum halves the slopes; a sum passes the whole slope 1 to each input."""

TASKS = ("02.1", "02.5")
LOSES = (
    "02.1.slopes",
    "02.1.square",
    "02.1.many",
    "02.5.worked",
    "02.5.expressions",
    "02.5.random",
)
REPLACE = [("((self, 1.0), (other, 1.0))", "((self, 0.5), (other, 0.5))")]
