"""You look up values in a list; that takes longer with each value. Use a set."""

TASKS = ("02.4",)
LOSES = ("02.4.chain", "02.4.work")
REPLACE = [("[], set()", "[], []"), ("seen.add(node)", "seen.append(node)")]
