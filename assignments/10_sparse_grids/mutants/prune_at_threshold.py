"""A share equal to the threshold is not more than it."""

TASKS = ("10.5",)
LOSES = ("10.5.pruned",)
REPLACE = [("worth > threshold", "worth >= threshold")]
