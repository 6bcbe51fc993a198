"""Both terms of the rotation have a factor of 2."""

TASKS = ("15.1",)
LOSES = ("15.1.axes", "15.1.same", "15.1.differences", "15.1.hidden")
REPLACE = [("2 * (w * K + K @ K)", "(w * K + K @ K)")]
