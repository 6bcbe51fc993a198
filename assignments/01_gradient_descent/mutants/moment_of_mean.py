"""your second moment averages m squared: it averages g squared"""

TASKS = ("01.5",)
LOSES = ("01.5.constant", "01.5.trace", "01.5.sums")
REPLACE = [("(1.0 - beta2) * g * g", "(1.0 - beta2) * m * m")]
