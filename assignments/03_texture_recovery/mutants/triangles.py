"""You interpolate over two triangles: the fourth texel has no weight."""

TASKS = ("03.1",)
LOSES = ("03.1.product", "03.1.hidden")
REPLACE = [
    (
        "return (1 - t) * above + t * below",
        (
            "corner = T[top, left] - T[top, right] - T[bottom, left] + T[bottom, right]\n"
            "    return (1 - t) * above + t * below - s * t * corner"
        ),
    )
]
