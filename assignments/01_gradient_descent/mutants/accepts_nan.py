"""you accept a step to where f is NaN: NaN > bound is False, so ask for `not value <= bound`"""

TASKS = ("01.6",)
LOSES = ("01.6.undefined",)
REPLACE = [("while not f(x + tau * d) <= start", "while f(x + tau * d) > start")]
