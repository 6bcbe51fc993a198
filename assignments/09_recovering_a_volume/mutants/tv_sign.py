"""Your derivative has the wrong sign: descent would roughen."""

TASKS = ("09.4",)
LOSES = ("09.4.differences", "09.4.hidden")
REPLACE = [("/ count), d_grid", "/ count), -d_grid")]
