"""The root's derivative is the difference divided by the root: you leave the root out."""

TASKS = ("09.4",)
LOSES = ("09.4.differences", "09.4.hidden")
REPLACE = [("ahead / length / count", "ahead / count")]
