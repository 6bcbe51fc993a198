"""d_q is divided by the length of q as well."""

TASKS = ("15.1",)
LOSES = ("15.1.differences", "15.1.length", "15.1.hidden")
REPLACE = [("(d_n - along * n) / length", "(d_n - along * n)")]
