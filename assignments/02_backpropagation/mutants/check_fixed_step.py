"""Your step does not grow with the coordinate: at 1e8 a step of 1e-5 is rounding."""

TASKS = ("02.6",)
LOSES = ("02.6.large", "02.6.scale")
REPLACE = [("eps * max(1.0, abs(x[i]))", "eps")]
