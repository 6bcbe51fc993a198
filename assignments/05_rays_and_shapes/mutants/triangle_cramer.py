"""Weights are measured from a corner, differently in each triangle: rounding opens edges."""

TASKS = ("05.2",)
LOSES = ("05.2.edges",)
REPLACE = [
    (
        "np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)])",
        "np.stack([a * 0, a * 0, np.cross(-a, b - a)])",
    ),
    (
        "    whole = np.sum(volumes, axis=0)\n",
        "    p = np.cross(direction, c - a)\n"
        "    whole, volumes[1] = np.sum((b - a) * p, axis=1), np.sum(-a * p, axis=1)\n"
        "    volumes[0] = whole - volumes[1] - volumes[2]\n",
    ),
]
