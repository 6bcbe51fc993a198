"""Your power has the slope of n**x, value times log; here the exponent is the constant."""

TASKS = ("02.3", "02.5")
LOSES = ("02.3.power", "02.3.many", "02.5.expressions", "02.5.random")
REPLACE = [("n * self.data ** (n - 1)", "self.data**n * math.log(abs(self.data) + 1e-300)")]
