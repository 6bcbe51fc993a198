"""It is not looked at whether the lamp that was drawn is the one that is met."""

TASKS = ("07.6",)
LOSES = ("07.6.hidden", "07.6.zero")
REPLACE = [('counts[:n] &= found["thing"][:n] == lamp', 'counts[:n] &= found["thing"][:n] >= 0')]
