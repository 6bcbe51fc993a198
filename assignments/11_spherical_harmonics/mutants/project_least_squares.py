"""You solve for the coefficients that fit the samples: the projection is an integral."""

TASKS = ("11.2",)
LOSES = ("11.2.rest", "11.2.hidden")
REPLACE = [
    (
        ("    return sh_basis(directions, degree).T @ (weights[:, None] * values)\n"),
        ("    return np.linalg.lstsq(sh_basis(directions, degree), values, None)[0]\n"),
    )
]
