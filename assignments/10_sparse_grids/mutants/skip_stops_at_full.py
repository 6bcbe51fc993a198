"""The ray ends in the first full leaf; a volume is not a wall."""

TASKS = ("10.2",)
LOSES = ("10.2.samples", "10.2.faces", "10.2.cost", "10.2.hidden")
REPLACE = [("live = live[after < count]", "live = live[(after < count) & ~full]")]
