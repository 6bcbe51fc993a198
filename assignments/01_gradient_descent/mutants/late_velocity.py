"""you move with the old velocity: update it first, then move"""

TASKS = ("01.4",)
LOSES = ("01.4.constant", "01.4.plain", "01.4.roots")
REPLACE = [
    (
        "        v = beta * v + grad(x[k])\n        x[k + 1] = x[k] - tau * v",
        "        x[k + 1] = x[k] - tau * v\n        v = beta * v + grad(x[k])",
    )
]
