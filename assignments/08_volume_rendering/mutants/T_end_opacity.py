"""You return the opacity 1 - T_end in place of T_end."""

TASKS = ("08.1",)
LOSES = ("08.1.constant", "08.1.slabs", "08.1.weights", "08.1.hidden")
REPLACE = [("* background, T_end", "* background, 1 - T_end")]
