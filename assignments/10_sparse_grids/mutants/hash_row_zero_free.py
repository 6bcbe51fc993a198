"""Row 0 is a row: only -1 says that a slot is free."""

TASKS = ("10.3",)
LOSES = ("10.3.found", "10.3.again", "10.3.room", "10.3.hidden")
REPLACE = [("if entry[3] < 0 or", "if entry[3] <= 0 or")]
