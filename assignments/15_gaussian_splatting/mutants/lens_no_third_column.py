"""J has a third column: what is off the axis moves on the screen when it comes nearer."""

TASKS = ("15.2",)
LOSES = ("15.2.sampled", "15.2.differences", "15.2.held", "15.2.hidden")
REPLACE = [("(W[:2] - h[:, :, None] * W[2])", "(W[:2] - 0 * h[:, :, None] * W[2])")]
