"""Only a quaternion of length 1 turns: divide q by its length first."""

TASKS = ("15.1",)
LOSES = ("15.1.same", "15.1.differences", "15.1.length", "15.1.hidden")
REPLACE = [(("    n = quats / length\n"), ("    n = quats\n"))]
