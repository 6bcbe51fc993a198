"""Your samples lie half a texel off: the centre of column 0 is at u = 0.5 / W."""

TASKS = ("03.1",)
LOSES = ("03.1.centres", "03.1.ramp", "03.1.product", "03.1.edge", "03.1.hidden")
REPLACE = [
    ("uv[:, 0] * columns - 0.5", "uv[:, 0] * columns"),
    ("uv[:, 1] * rows - 0.5", "uv[:, 1] * rows"),
]
