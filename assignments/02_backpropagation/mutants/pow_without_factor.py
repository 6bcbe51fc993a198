"""Your power's slope lacks the factor n."""

TASKS = ("02.3", "02.5")
LOSES = ("02.3.power", "02.3.many", "02.5.expressions", "02.5.random")
REPLACE = [("n * self.data ** (n - 1)", "self.data ** (n - 1)")]
