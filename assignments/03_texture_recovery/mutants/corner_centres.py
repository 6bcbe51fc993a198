"""You put the outermost texels' centres on the texture's edge: x is u W - 0.5, not u (W - 1)."""

TASKS = ("03.1",)
LOSES = ("03.1.centres", "03.1.ramp", "03.1.product", "03.1.edge", "03.1.hidden")
REPLACE = [
    ("uv[:, 0] * columns - 0.5", "uv[:, 0] * (columns - 1)"),
    ("uv[:, 1] * rows - 0.5", "uv[:, 1] * (rows - 1)"),
]
