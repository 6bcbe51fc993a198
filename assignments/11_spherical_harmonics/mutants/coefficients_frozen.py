"""Your coefficients never move."""

TASKS = ("11.6",)
LOSES = ("11.6.first", "11.6.hidden", "11.6.gain")
REPLACE = [
    (("            coefficients = of_coefficients.step(coefficients, d_coefficients)\n"), (""))
]
