"""Your maximum takes the smaller number."""

TASKS = ("02.2", "02.5")
LOSES = ("02.2.routes", "02.2.many", "02.5.worked", "02.5.expressions", "02.5.random")
REPLACE = [("self.data > other.data", "self.data < other.data")]
