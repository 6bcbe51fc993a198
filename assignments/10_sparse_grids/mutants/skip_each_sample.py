"""Every sample asks for its leaf: nothing is skipped."""

TASKS = ("10.2",)
LOSES = ("10.2.cost",)
REPLACE = [("np.maximum(jump, 1)", "np.minimum(np.maximum(jump, 1), 1)")]
