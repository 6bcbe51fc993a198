"""Without steps you give the very array back that you were given: give a copy."""

TASKS = ("09.6",)
LOSES = ("09.6.start",)
REPLACE = [("return grid.copy(), losses", "return grid, losses")]
