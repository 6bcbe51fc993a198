"""The nearest splat comes first: yours is the farthest."""

TASKS = ("15.4",)
LOSES = ("15.4.layers", "15.4.hidden")
REPLACE = [
    ('order = np.argsort(depth, kind="stable")', 'order = np.argsort(-depth, kind="stable")')
]
