"""The weight of the right texel multiplies the lower one, and the reverse."""

TASKS = ("03.1",)
LOSES = ("03.1.ramp", "03.1.product", "03.1.hidden")
REPLACE = [
    ("(1 - s) * T[top, left] + s * T[top, right]", "(1 - s) * T[top, left] + s * T[bottom, left]"),
    (
        "(1 - s) * T[bottom, left] + s * T[bottom, right]",
        "(1 - s) * T[top, right] + s * T[bottom, right]",
    ),
]
