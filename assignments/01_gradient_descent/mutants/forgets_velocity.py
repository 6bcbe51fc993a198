"""your velocity keeps nothing: the term beta v is missing"""

TASKS = ("01.4",)
LOSES = ("01.4.constant", "01.4.roots")
REPLACE = [("v = beta * v + grad(x[k])", "v = grad(x[k])")]
