"""Your result divides by the number of rows, not by the number of pixels."""

TASKS = ("00.1",)
LOSES = ("00.1.differences", "00.1.step")
REPLACE = [
    ("2.0 * (picture - photograph) / picture.size", "2.0 * (picture - photograph) / len(picture)")
]
