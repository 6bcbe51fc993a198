"""Only your first photograph counts."""

TASKS = ("09.5",)
LOSES = ("09.5.differences", "09.5.hidden", "09.5.scene")
REPLACE = [('for view in range(len(views["pictures"])):', "for view in range(1):")]
