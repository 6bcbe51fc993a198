"""Your rotation is the inverse one: mind the sign of the term with w."""

TASKS = ("15.1",)
LOSES = ("15.1.axes", "15.1.differences", "15.1.hidden")
REPLACE = [("2 * (w * K + K @ K)", "2 * (K @ K - w * K)")]
