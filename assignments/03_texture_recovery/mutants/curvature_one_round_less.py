"""Your estimate belongs to one round less."""

TASKS = ("03.4",)
LOSES = ("03.4.rounds", "03.4.hidden")
REPLACE = [(("for _ in range(n):\n        x ="), ("for _ in range(n - 1):\n        x ="))]
