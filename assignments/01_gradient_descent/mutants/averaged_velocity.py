"""your velocity is a mean: Eq. (12) adds the whole gradient, not (1 - beta) of it"""

TASKS = ("01.4",)
LOSES = ("01.4.constant", "01.4.roots")
REPLACE = [("v = beta * v + grad(x[k])", "v = beta * v + (1.0 - beta) * grad(x[k])")]
