"""Parts are drawn from the whole, long where it is long: L times the numbers drawn."""

TASKS = ("15.6",)
LOSES = ("15.6.values", "15.6.hidden")
REPLACE = [
    (
        'np.einsum("nij,nj->ni", np.linalg.cholesky(whole), drawn)',
        'drawn * np.exp(after["log_scales"][fresh])',
    )
]
