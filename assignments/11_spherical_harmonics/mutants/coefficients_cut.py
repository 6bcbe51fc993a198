"""You cut coefficients off at zero: only densities are never negative."""

TASKS = ("11.6",)
LOSES = ("11.6.first", "11.6.hidden")
REPLACE = [
    (
        ("            coefficients = of_coefficients.step(coefficients, d_coefficients)\n"),
        (
            "            coefficients = np.maximum(of_coefficients.step(coefficients, "
            "d_coefficients), 0)\n"
        ),
    )
]
