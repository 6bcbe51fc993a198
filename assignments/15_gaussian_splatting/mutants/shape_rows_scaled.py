"""You scale the rows of R: its columns are the axes."""

TASKS = ("15.1",)
LOSES = ("15.1.axes", "15.1.differences", "15.1.hidden")
REPLACE = [(("    M = R * s\n"), ("    M = R * s.swapaxes(1, 2)\n"))]
