"""A direction with a zero in it misses every box."""

TASKS = ("05.6",)
LOSES = ("05.6.axes", "05.6.cost", "05.6.growth")
REPLACE = [("if ((origin < low) | (origin > high))[~moves].any():", "if not moves.all():")]
