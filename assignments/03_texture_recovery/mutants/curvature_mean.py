"""Your estimate is that of a texture of ones, whatever n: no round has been made."""

TASKS = ("03.4",)
LOSES = ("03.4.rounds", "03.4.bound", "03.4.hidden")
REPLACE = [(("for _ in range(n):\n        x ="), ("for _ in range(0):\n        x ="))]
