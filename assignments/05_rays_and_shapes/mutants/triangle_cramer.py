"""The weights are computed from a corner, differently in each triangle: rounding opens the edges."""

TASKS = ("05.2",)
LOSES = ("05.2.edges",)
REPLACE = [
    (
        "volumes = np.sum(np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)]) * direction, axis=2)",
        "p, q = np.cross(direction, c - a), np.cross(-a, b - a)\n    u, v, w = np.sum(-a * p, axis=1), np.sum(direction * q, axis=1), np.sum((b - a) * p, axis=1)\n    volumes = np.stack([w - u - v, u, v])",
    ),
]
