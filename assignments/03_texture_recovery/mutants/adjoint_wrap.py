"""Your adjoint hands a share of border samples to the opposite side of the texture."""

TASKS = ("03.2",)
LOSES = ("03.2.transpose", "03.2.edge", "03.2.hidden", "03.2.cost")
REPLACE = [
    ("np.clip(width * uv[:, 0] - 0.5, 0, width - 1)", "width * uv[:, 0] - 0.5"),
    ("np.clip(height * uv[:, 1] - 0.5, 0, height - 1)", "height * uv[:, 1] - 0.5"),
    (
        "j0, i0 = across.astype(int), down.astype(int)",
        "j0, i0 = np.floor(across).astype(int), np.floor(down).astype(int)",
    ),
    (
        "j1, i1 = np.minimum(j0 + 1, width - 1), np.minimum(i0 + 1, height - 1)",
        "j1, i1 = (j0 + 1) % width, (i0 + 1) % height",
    ),
    (
        "(across - j0)[:, None], (down - i0)[:, None]",
        ("(across - j0)[:, None], (down - i0)[:, None]\n    j0, i0 = j0 % width, i0 % height"),
    ),
]
