"""Your d_v leaves out g."""

TASKS = ("11.3",)
LOSES = ("11.3.vectors", "11.3.length", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ('    pull = np.einsum("nkc,nc->kn", coefficients, g)\n'),
        ("    pull = coefficients.sum(axis=2).T\n"),
    )
]
