"""Your power's slope is n * value / x, which fails at x = 0; n x**(n - 1) does not."""

TASKS = ("02.3",)
LOSES = ("02.3.power",)
REPLACE = [("n * self.data ** (n - 1)", "n * self.data**n / self.data")]
