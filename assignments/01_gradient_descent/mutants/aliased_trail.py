"""all your points are the last one: `point -= ...` changes the array that was already stored"""

TASKS = ("01.3",)
LOSES = ("01.3.rates", "01.3.stability", "01.3.contraction")
REPLACE = [
    (
        "    for k in range(n):\n        x[k + 1] = x[k] - tau * grad(x[k])\n    loss",
        ("    for k in range(n):\n        x[: k + 2] = x[k] - tau * grad(x[k])\n    loss"),
    )
]
