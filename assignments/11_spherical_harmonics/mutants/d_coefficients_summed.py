"""Your d_coefficients add the channels up: each channel has its own g."""

TASKS = ("11.3",)
LOSES = ("11.3.coefficients", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ("    d_coefficients = sh_basis(d, degree)[:, :, None] * g[:, None, :]\n"),
        (
            "    d_coefficients = sh_basis(d, degree)[:, :, None] * (g.sum(axis=1)[:, "
            "None, None] + 0 * g[:, None, :])\n"
        ),
    )
]
