"""The right texel's weight goes to the lower texel, forwards and backwards alike."""

TASKS = ("03.1", "03.2")
LOSES = ("03.1.ramp", "03.1.product", "03.1.hidden", "03.2.single", "03.2.hidden", "03.2.cost")
REPLACE = [
    ("(1 - s) * T[top, left] + s * T[top, right]", "(1 - s) * T[top, left] + s * T[bottom, left]"),
    (
        "(1 - s) * T[bottom, left] + s * T[bottom, right]",
        "(1 - s) * T[top, right] + s * T[bottom, right]",
    ),
    ("(i0, j1), (1 - fv) * fu * g", "(i0, j1), fv * (1 - fu) * g"),
    ("(i1, j0), fv * (1 - fu) * g", "(i1, j0), (1 - fv) * fu * g"),
]
