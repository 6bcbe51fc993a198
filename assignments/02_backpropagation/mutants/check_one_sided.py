"""Your differences have one side only: their error is of order eps, not eps squared."""

TASKS = ("02.6",)
LOSES = ("02.6.accepts", "02.6.large", "02.6.rejects", "02.6.scale")
REPLACE = [("(f(ahead)[0] - f(behind)[0]) / (2.0 * step)", "(f(ahead)[0] - f(x.copy())[0]) / step")]
