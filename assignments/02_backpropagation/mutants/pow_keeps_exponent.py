"""Your power's slope keeps the exponent: n x**n instead of n x**(n - 1)."""

TASKS = ("02.3", "02.5")
LOSES = ("02.3.power", "02.3.many", "02.5.expressions", "02.5.random")
REPLACE = [("n * self.data ** (n - 1)", "n * self.data**n")]
