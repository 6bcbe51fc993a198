"""In your adjoint the right texel gets the lower one's weight, and the reverse."""

TASKS = ("03.2",)
LOSES = ("03.2.single", "03.2.transpose", "03.2.hidden", "03.2.cost")
REPLACE = [
    ("(i0, j1), (1 - fv) * fu * g", "(i0, j1), fv * (1 - fu) * g"),
    ("(i1, j0), fv * (1 - fu) * g", "(i1, j0), (1 - fv) * fu * g"),
]
