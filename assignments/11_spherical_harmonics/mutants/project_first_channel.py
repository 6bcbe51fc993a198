"""Every channel of your projection is the first one."""

TASKS = ("11.2",)
LOSES = ("11.2.back", "11.2.rest", "11.2.hidden")
REPLACE = [
    (
        ("    return sh_basis(directions, degree).T @ (weights[:, None] * values)\n"),
        (
            "    return sh_basis(directions, degree).T @ (weights[:, None] * values[:, :1] "
            "* np.ones(values.shape[1]))\n"
        ),
    )
]
