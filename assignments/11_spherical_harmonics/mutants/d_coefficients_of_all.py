"""Each row of your d_coefficients is the mean over all rows."""

TASKS = ("11.3",)
LOSES = ("11.3.coefficients", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ("    d_coefficients = sh_basis(d, degree)[:, :, None] * g[:, None, :]\n"),
        (
            "    d_coefficients = sh_basis(d, degree)[:, :, None] * g[:, None, :]\n"
            "    d_coefficients = np.broadcast_to(d_coefficients.mean(axis=0), "
            "coefficients.shape).copy()\n"
        ),
    )
]
