"""your walk goes uphill: the step is tau times minus the derivative"""

TASKS = ("01.2",)
LOSES = ("01.2.rate", "01.2.verdict", "01.2.basins", "01.2.undefined")
REPLACE = [("x[k] - tau * df(float(x[k]))", "x[k] + tau * df(float(x[k]))")]
