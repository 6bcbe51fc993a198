"""beta1 and beta2 are swapped"""

TASKS = ("01.5",)
LOSES = ("01.5.trace", "01.5.sums")
REPLACE = [
    ("m = beta1 * m + (1.0 - beta1) * g", "m = beta2 * m + (1.0 - beta2) * g"),
    ("v = beta2 * v + (1.0 - beta2) * g * g", "v = beta1 * v + (1.0 - beta1) * g * g"),
    ("1.0 - beta1**k", "1.0 - beta2**k"),
    ("v / (1.0 - beta2**k)", "v / (1.0 - beta1**k)"),
]
