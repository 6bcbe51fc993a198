"""You move x itself, and both points are the same array; each has to be a copy of its own."""

TASKS = ("02.6",)
LOSES = ("02.6.accepts", "02.6.large", "02.6.rejects", "02.6.scale")
REPLACE = [
    ("x = np.array(x, dtype=np.float64)", "x = np.asarray(x, dtype=np.float64)"),
    ("ahead, behind = x.copy(), x.copy()", "ahead, behind = x, x"),
]
