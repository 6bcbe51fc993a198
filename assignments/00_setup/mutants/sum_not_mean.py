"""Your result is the derivative of the sum: divide by the number of pixels."""

TASKS = ("00.1",)
LOSES = ("00.1.differences", "00.1.step")
REPLACE = [("2.0 * (picture - photograph) / picture.size", "2.0 * (picture - photograph)")]
