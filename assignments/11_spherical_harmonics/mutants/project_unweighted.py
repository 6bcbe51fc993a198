"""Your projection gives each direction the same weight: use its solid angle."""

TASKS = ("11.2",)
LOSES = ("11.2.back", "11.2.rest", "11.2.hidden")
REPLACE = [
    (
        ("    return sh_basis(directions, degree).T @ (weights[:, None] * values)\n"),
        ("    return sh_basis(directions, degree).T @ (4 * np.pi / len(weights) * values)\n"),
    )
]
