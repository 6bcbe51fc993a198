"""Your root starts from 1 whatever the seed is."""

TASKS = ("02.5",)
LOSES = ("02.5.seed",)
REPLACE = [("root.grad = float(seed)", "root.grad = 1.0")]
