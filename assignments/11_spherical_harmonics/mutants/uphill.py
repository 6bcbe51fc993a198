"""Your fit climbs: `step` wants the derivative itself."""

TASKS = ("11.6",)
LOSES = ("11.6.first", "11.6.hidden", "11.6.gain")
REPLACE = [
    (
        ("            density = np.maximum(of_density.step(density, d_density), 0)\n"),
        ("            density = np.maximum(of_density.step(density, -d_density), 0)\n"),
    ),
    (
        ("            coefficients = of_coefficients.step(coefficients, d_coefficients)\n"),
        ("            coefficients = of_coefficients.step(coefficients, -d_coefficients)\n"),
    ),
]
