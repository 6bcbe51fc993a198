"""The table that was given has changed: copy it first."""

TASKS = ("10.3",)
LOSES = ("10.3.kept",)
REPLACE = [("table = table.copy()", "table.setflags(write=True)")]
