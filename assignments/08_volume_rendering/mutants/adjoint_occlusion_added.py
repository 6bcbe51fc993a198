"""What a step hides is lost: it counts minus in d_sigma."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.background", "08.2.walls", "08.2.hidden", "08.2.cost")
REPLACE = [("(after * v - left)", "(after * v + left)")]
