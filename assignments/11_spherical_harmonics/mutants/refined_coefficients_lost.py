"""Your coefficients start from zero at each level."""

TASKS = ("11.6",)
LOSES = ("11.6.refine", "11.6.hidden", "11.6.gain")
REPLACE = [
    (
        (
            '            coefficients = np.einsum("en,en...->n...", weight, '
            "rows).reshape(*fine, *rest)\n"
        ),
        ("            coefficients = np.zeros((*fine, *rest))\n"),
    )
]
