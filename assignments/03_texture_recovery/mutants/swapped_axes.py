"""u counts columns and v counts rows: yours are swapped."""

TASKS = ("03.1",)
LOSES = ("03.1.centres", "03.1.ramp", "03.1.product", "03.1.edge", "03.1.hidden")
REPLACE = [("uv[:, 0] * columns", "uv[:, 1] * columns"), ("uv[:, 1] * rows", "uv[:, 0] * rows")]
