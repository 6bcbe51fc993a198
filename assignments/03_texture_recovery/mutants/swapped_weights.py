"""The right and the lower texel have each other's weight: equation (6) has row before column."""

TASKS = ("03.1",)
LOSES = ("03.1.ramp", "03.1.product", "03.1.hidden")
REPLACE = [
    ("(1 - s) * T[top, left] + s * T[top, right]", "(1 - s) * T[top, left] + s * T[bottom, left]"),
    (
        "(1 - s) * T[bottom, left] + s * T[bottom, right]",
        "(1 - s) * T[top, right] + s * T[bottom, right]",
    ),
]
