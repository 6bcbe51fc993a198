"""Your coefficients' derivative is taken after the density has moved: take both at one point."""

TASKS = ("11.6",)
LOSES = ("11.6.first", "11.6.hidden")
REPLACE = [
    (
        ("            coefficients = of_coefficients.step(coefficients, d_coefficients)\n"),
        (
            "            d_coefficients = loss_and_grad(density, coefficients, samples, "
            "target)[2]\n"
            "            coefficients = of_coefficients.step(coefficients, d_coefficients)\n"
        ),
    )
]
