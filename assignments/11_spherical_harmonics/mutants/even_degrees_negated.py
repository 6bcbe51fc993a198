"""Your rotation also reflects: the odd degrees have the other sign."""

TASKS = ("11.4",)
LOSES = ("11.4.turns", "11.4.compose", "11.4.hidden")
REPLACE = [
    (
        ("    before = sh_basis(directions @ R, degree) @ coefficients\n"),
        ("    before = sh_basis(-directions @ R, degree) @ coefficients\n"),
    )
]
