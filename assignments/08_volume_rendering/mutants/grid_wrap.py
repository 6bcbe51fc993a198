"""Your border wraps around: the value at the border should hold."""

TASKS = ("08.4",)
LOSES = ("08.4.edge", "08.4.hidden")
REPLACE = [
    ("place = np.clip(u * counts - 0.5, 0, counts - 1)", "place = u * counts - 0.5"),
    ("near = place.astype(int)\n", "near = np.floor(place).astype(int)\n"),
    ("far = np.minimum(near + 1, counts - 1)", "far = near + 1"),
    (
        "i, j, k = np.where(corner, far, near).T",
        "i, j, k = (np.where(corner, far, near) % counts).T",
    ),
]
