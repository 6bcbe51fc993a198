"""Your d_coefficients ask for the harmonics at v: they belong to d, of length 1."""

TASKS = ("11.3",)
LOSES = ("11.3.coefficients", "11.3.length", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ("    d_coefficients = sh_basis(d, degree)[:, :, None] * g[:, None, :]\n"),
        ("    d_coefficients = sh_basis(v, degree)[:, :, None] * g[:, None, :]\n"),
    )
]
