"""Your sum adds absolute values: it is wrong as soon as a number is negative."""

TASKS = ("02.1", "02.5")
LOSES = ("02.1.values", "02.1.slopes", "02.1.many", "02.5.expressions", "02.5.random")
REPLACE = [("self.data + other.data", "abs(self.data) + abs(other.data)")]
