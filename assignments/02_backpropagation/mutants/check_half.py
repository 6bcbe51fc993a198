"""Your differences lack the 2 in the denominator: the two points are two steps apart."""

TASKS = ("02.6",)
LOSES = ("02.6.accepts", "02.6.large", "02.6.rejects", "02.6.scale")
REPLACE = [("(2.0 * step)", "step")]
