"""cov is in the world: it must be turned by W before J sees it."""

TASKS = ("15.2",)
LOSES = ("15.2.sampled", "15.2.differences", "15.2.held", "15.2.hidden")
REPLACE = [("(W[:2] - h[:, :, None] * W[2])", "(np.eye(3)[:2] - h[:, :, None] * np.eye(3)[2])")]
