"""Your rays pass through the corners of pixels: their middles lie half a pixel further."""

TASKS = ("09.2",)
LOSES = ("09.2.middle", "09.2.projected", "09.2.hidden")
REPLACE = [("right = (col + 0.5 -", "right = (col -"), ("down = (row + 0.5 -", "down = (row -")]
