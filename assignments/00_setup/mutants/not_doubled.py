"""Your result lacks the factor 2 of the derivative of a square."""

TASKS = ("00.1",)
LOSES = ("00.1.differences", "00.1.step")
REPLACE = [("2.0 * (picture - photograph) / picture.size", "(picture - photograph) / picture.size")]
