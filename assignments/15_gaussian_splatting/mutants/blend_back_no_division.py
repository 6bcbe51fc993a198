"""What is behind has passed through 1 - alpha already: divide by it."""

TASKS = ("15.4",)
LOSES = ("15.4.differences", "15.4.hidden")
REPLACE = [("rest / (1 - a)", "rest")]
