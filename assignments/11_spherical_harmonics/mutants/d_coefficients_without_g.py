"""Your d_coefficients are the harmonics themselves: multiply by g."""

TASKS = ("11.3",)
LOSES = ("11.3.coefficients", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ("    d_coefficients = sh_basis(d, degree)[:, :, None] * g[:, None, :]\n"),
        ("    d_coefficients = sh_basis(d, degree)[:, :, None] * np.sign(g * g)[:, None, :]\n"),
    )
]
