"""u counts columns and v counts rows: yours are swapped."""

TASKS = ("03.1", "03.2")
LOSES = (
    "03.1.centres",
    "03.1.ramp",
    "03.1.product",
    "03.1.edge",
    "03.1.hidden",
    "03.2.single",
    "03.2.edge",
    "03.2.hidden",
    "03.2.cost",
)
REPLACE = [
    ("uv[:, 0] * columns", "uv[:, 1] * columns"),
    ("uv[:, 1] * rows", "uv[:, 0] * rows"),
    ("width * uv[:, 0]", "width * uv[:, 1]"),
    ("height * uv[:, 1]", "height * uv[:, 0]"),
]
