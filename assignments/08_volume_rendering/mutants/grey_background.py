"""All channels get the first channel of the background."""

TASKS = ("08.1",)
LOSES = ("08.1.constant", "08.1.slabs", "08.1.hidden")
REPLACE = [("T_end[:, None] * background,", "T_end[:, None] * background[:1],")]
