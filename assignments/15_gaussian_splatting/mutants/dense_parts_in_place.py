"""Parts are drawn from the whole: yours stay in its middle."""

TASKS = ("15.6",)
LOSES = ("15.6.values", "15.6.hidden")
REPLACE = [
    (
        ('after["means"][fresh] += np.einsum("nij,nj->ni", np.linalg.cholesky(whole), drawn)'),
        "drawn *= 0",
    )
]
