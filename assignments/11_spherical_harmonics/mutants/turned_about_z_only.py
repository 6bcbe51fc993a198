"""Your rotation sees only the turn about z."""

TASKS = ("11.4",)
LOSES = ("11.4.turns", "11.4.compose", "11.4.hidden")
REPLACE = [
    (
        ("    before = sh_basis(directions @ R, degree) @ coefficients\n"),
        (
            "    a = np.arctan2(R[1, 0], R[0, 0])\n"
            "    R = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, "
            "0, 1.0]])\n"
            "    before = sh_basis(directions @ R, degree) @ coefficients\n"
        ),
    )
]
