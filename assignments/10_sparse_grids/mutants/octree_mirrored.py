"""The upper halves stand where the lower ones should."""

TASKS = ("10.1",)
LOSES = ("10.1.cells", "10.1.hidden")
REPLACE = [("slice(half * up, half * up + half)", "slice(half - half * up, 2 * half - half * up)")]
