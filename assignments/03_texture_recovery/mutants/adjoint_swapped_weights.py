"""The right and the lower texel have each other's weight: equation (6) has row before column."""

TASKS = ("03.2",)
LOSES = ("03.2.single", "03.2.transpose", "03.2.hidden", "03.2.cost")
REPLACE = [
    ("(i0, j1), (1 - fv) * fu * g", "(i0, j1), fv * (1 - fu) * g"),
    ("(i1, j0), fv * (1 - fu) * g", "(i1, j0), (1 - fv) * fu * g"),
]
