"""your corrections use beta^(k+1): in the first step the exponent is 1"""

TASKS = ("01.5",)
LOSES = ("01.5.constant", "01.5.trace", "01.5.sums")
REPLACE = [
    ("1.0 - beta1**k", "1.0 - beta1 ** (k + 1)"),
    ("1.0 - beta2**k", "1.0 - beta2 ** (k + 1)"),
]
