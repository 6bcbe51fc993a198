"""Your loss sums over channels and your derivative averages over them."""

TASKS = ("09.3",)
LOSES = ("09.3.differences", "09.3.chain", "09.3.hidden")
REPLACE = [
    (
        "return float(np.sum(residual**2) / len(residual)), 2 / len(residual) * residual",
        "return float(np.sum(residual**2) / len(residual)), 2 / residual.size * residual",
    )
]
