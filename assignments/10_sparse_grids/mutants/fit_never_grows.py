"""What was pruned never comes back: the list does not grow."""

TASKS = ("10.6",)
LOSES = ("10.6.chain", "10.6.hidden", "10.6.topology")
REPLACE = [
    ("*shares(values, samples), threshold, grow)", "*shares(values, samples), threshold, 0)")
]
