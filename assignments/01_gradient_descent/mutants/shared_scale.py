"""all your coordinates share one second moment: each has its own"""

TASKS = ("01.5",)
LOSES = ("01.5.constant", "01.5.trace", "01.5.sums")
REPLACE = [
    ("v = beta2 * v + (1.0 - beta2) * g * g", "v = beta2 * v + (1.0 - beta2) * np.mean(g * g)")
]
