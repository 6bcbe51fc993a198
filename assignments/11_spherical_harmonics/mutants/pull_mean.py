"""Your d_v takes the mean over channels: their pulls add up."""

TASKS = ("11.3",)
LOSES = ("11.3.vectors", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ('    pull = np.einsum("nkc,nc->kn", coefficients, g)\n'),
        ('    pull = np.einsum("nkc,nc->kn", coefficients, g) / g.shape[1]\n'),
    )
]
