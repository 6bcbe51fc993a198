"""you take the gradient where the velocity would lead: take it at the point itself"""

TASKS = ("01.4",)
LOSES = ("01.4.roots",)
REPLACE = [
    (
        "grad(x[k])\n        x[k + 1] = x[k] - tau * v",
        "grad(x[k] - tau * beta * v)\n        x[k + 1] = x[k] - tau * v",
    )
]
