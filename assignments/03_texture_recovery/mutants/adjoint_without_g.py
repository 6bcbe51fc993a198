"""Your adjoint adds up the weights and forgets to multiply by g."""

TASKS = ("03.2",)
LOSES = ("03.2.single", "03.2.transpose", "03.2.repeated", "03.2.edge", "03.2.hidden", "03.2.cost")
REPLACE = [
    ("(1 - fv) * (1 - fu) * g)", "(1 - fv) * (1 - fu) * (g != 0))"),
    ("(1 - fv) * fu * g)", "(1 - fv) * fu * (g != 0))"),
    (", fv * (1 - fu) * g)", ", fv * (1 - fu) * (g != 0))"),
    (", fv * fu * g)", ", fv * fu * (g != 0))"),
]
