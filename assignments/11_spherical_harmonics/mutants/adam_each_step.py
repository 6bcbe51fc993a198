"""You make a new Adam for each step, which forgets what it has seen: a new one for each level."""

TASKS = ("11.6",)
LOSES = ("11.6.first", "11.6.hidden")
REPLACE = [
    (("        of_density, of_coefficients = Adam(), Adam()\n"), ("")),
    (
        (
            "            value, d_density, d_coefficients = loss_and_grad(density, "
            "coefficients, samples, target)\n"
        ),
        (
            "            value, d_density, d_coefficients = loss_and_grad(density, "
            "coefficients, samples, target)\n"
            "            of_density, of_coefficients = Adam(), Adam()\n"
        ),
    ),
]
