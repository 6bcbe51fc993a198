"""Your result is the negative of the derivative: it is picture minus photograph."""

TASKS = ("00.1",)
LOSES = ("00.1.differences", "00.1.step")
REPLACE = [
    ("2.0 * (picture - photograph) / picture.size", "2.0 * (photograph - picture) / picture.size")
]
