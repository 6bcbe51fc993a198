"""Row 0 is on top and the camera's y points down: yours points up."""

TASKS = ("09.2",)
LOSES = ("09.2.projected", "09.2.hidden")
REPLACE = [("down = (row", "down = -(row")]
