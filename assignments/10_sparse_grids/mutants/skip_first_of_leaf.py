"""Only the first sample in a full leaf is taken; all that follow in it share the leaf."""

TASKS = ("10.2",)
LOSES = ("10.2.samples", "10.2.faces", "10.2.cost", "10.2.hidden")
REPLACE = [("(number < after[:, None])", "(number < k[live, None] + 1)")]
