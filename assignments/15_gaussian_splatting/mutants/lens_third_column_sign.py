"""The third column of J has a minus: what goes away moves towards the middle."""

TASKS = ("15.2",)
LOSES = ("15.2.sampled", "15.2.differences", "15.2.held", "15.2.hidden")
REPLACE = [("(W[:2] - h[:, :, None] * W[2])", "(W[:2] + h[:, :, None] * W[2])")]
