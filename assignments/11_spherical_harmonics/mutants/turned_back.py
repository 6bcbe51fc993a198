"""Your function turns the wrong way: what is at d now stood at R^T d before."""

TASKS = ("11.4",)
LOSES = ("11.4.turns", "11.4.compose", "11.4.hidden")
REPLACE = [
    (
        ("    before = sh_basis(directions @ R, degree) @ coefficients\n"),
        ("    before = sh_basis(directions @ R.T, degree) @ coefficients\n"),
    )
]
