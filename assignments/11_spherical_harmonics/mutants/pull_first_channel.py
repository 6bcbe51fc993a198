"""Your d_v knows the first channel alone: all channels pull."""

TASKS = ("11.3",)
LOSES = ("11.3.vectors", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ('    pull = np.einsum("nkc,nc->kn", coefficients, g)\n'),
        ("    pull = (coefficients[:, :, 0] * g[:, :1]).T\n"),
    )
]
