"""Your adjoint calls the forward function for each coefficient: right, but far too dear."""

TASKS = ("11.3",)
LOSES = ("11.3.cost",)
REPLACE = [
    (
        ("    d_coefficients = sh_basis(d, degree)[:, :, None] * g[:, None, :]\n"),
        (
            "    d_coefficients = np.zeros(coefficients.shape)\n"
            "    for k, c in np.ndindex(coefficients.shape[1:]):\n"
            "        unit = np.zeros(coefficients.shape)\n"
            "        unit[:, k, c] = 1.0\n"
            "        d_coefficients[:, k, c] = np.sum(sh_color(unit, v) * g, axis=1)\n"
        ),
    )
]
