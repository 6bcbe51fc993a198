"""You sum absolute errors: equation (7) sums their squares."""

TASKS = ("09.3",)
LOSES = ("09.3.values", "09.3.hidden")
REPLACE = [
    (
        "return float(np.sum(residual**2) / len(residual)), 2 / len(residual) * residual",
        "return float(np.sum(np.abs(residual)) / len(residual)), np.sign(residual) / len(residual)",
    )
]
