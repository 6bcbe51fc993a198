"""Beyond the outermost centres you extend the slope: the value at the border should hold."""

TASKS = ("03.1",)
LOSES = ("03.1.edge", "03.1.hidden")
REPLACE = [
    ("x = np.clip(uv[:, 0] * columns - 0.5, 0, columns - 1)", "x = uv[:, 0] * columns - 0.5"),
    ("y = np.clip(uv[:, 1] * rows - 0.5, 0, rows - 1)", "y = uv[:, 1] * rows - 0.5"),
    (
        "left, top = np.floor(x).astype(int), np.floor(y).astype(int)",
        (
            "left = np.clip(np.floor(x), 0, max(columns - 2, 0)).astype(int)\n"
            "    top = np.clip(np.floor(y), 0, max(rows - 2, 0)).astype(int)"
        ),
    ),
]
