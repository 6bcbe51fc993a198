"""Beyond the outermost centres you extend the slope: the value at the border should hold."""

TASKS = ("08.4",)
LOSES = ("08.4.edge", "08.4.hidden")
REPLACE = [
    ("place = np.clip(u * counts - 0.5, 0, counts - 1)", "place = u * counts - 0.5"),
    (
        "near = place.astype(int)\n",
        "near = np.clip(np.floor(place).astype(int), 0, np.maximum(counts - 2, 0))\n",
    ),
]
