"""On a face, along it, zero is divided by zero, and the box is missed."""

TASKS = ("05.6",)
LOSES = ("05.6.axes",)
REPLACE = [
    ("moves = direction != 0", "moves = np.ones(3, bool)"),
    (
        "        faces = (np.stack([low, high]) - origin)[:, moves] / direction[moves]\n",
        '        with np.errstate(all="ignore"):\n'
        "            faces = (np.stack([low, high]) - origin)[:, moves] / direction[moves]\n",
    ),
]
