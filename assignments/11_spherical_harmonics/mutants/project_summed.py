"""Your projection adds values without any weights."""

TASKS = ("11.2",)
LOSES = ("11.2.back", "11.2.rest", "11.2.hidden")
REPLACE = [
    (
        ("    return sh_basis(directions, degree).T @ (weights[:, None] * values)\n"),
        ("    return sh_basis(directions, degree).T @ (values)\n"),
    )
]
