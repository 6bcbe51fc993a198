"""Nothing is ever pruned."""

TASKS = ("10.6",)
LOSES = ("10.6.chain", "10.6.hidden", "10.6.topology")
REPLACE = [("*shares(values, samples), threshold, grow)", "*shares(values, samples), -1.0, grow)")]
