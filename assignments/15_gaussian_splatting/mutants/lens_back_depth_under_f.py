"""J has t_z under f: what comes nearer grows."""

TASKS = ("15.2",)
LOSES = ("15.2.differences", "15.2.held", "15.2.hidden")
REPLACE = [((" - np.sum(d_A * A, axis=(1, 2))\n"), ("\n"))]
