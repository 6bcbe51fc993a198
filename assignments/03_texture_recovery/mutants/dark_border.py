"""Beyond the outermost centres your texture fades to 0: the value at the border should hold."""

TASKS = ("03.1",)
LOSES = ("03.1.constant", "03.1.edge", "03.1.hidden")
REPLACE = [
    (
        "return (1 - t) * above + t * below",
        (
            "inside = np.abs(uv[:, 0] - 0.5) * columns <= (columns - 1) / 2 + 1e-9\n"
            "    inside &= np.abs(uv[:, 1] - 0.5) * rows <= (rows - 1) / 2 + 1e-9\n"
            "    return inside[:, None] * ((1 - t) * above + t * below)"
        ),
    )
]
