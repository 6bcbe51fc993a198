"""Beyond the border your texture starts again: the value at the border should hold."""

TASKS = ("03.1",)
LOSES = ("03.1.edge", "03.1.hidden")
REPLACE = [
    ("x = np.clip(uv[:, 0] * columns - 0.5, 0, columns - 1)", "x = uv[:, 0] * columns - 0.5"),
    ("y = np.clip(uv[:, 1] * rows - 0.5, 0, rows - 1)", "y = uv[:, 1] * rows - 0.5"),
    (
        "right, bottom = np.minimum(left + 1, columns - 1), np.minimum(top + 1, rows - 1)",
        "right, bottom = (left + 1) % columns, (top + 1) % rows",
    ),
    (
        "s, t = (x - left)[:, None], (y - top)[:, None]",
        (
            "s, t = (x - left)[:, None], (y - top)[:, None]\n"
            "    left, top = left % columns, top % rows"
        ),
    ),
]
