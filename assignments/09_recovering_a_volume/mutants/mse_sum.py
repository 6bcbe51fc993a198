"""You sum over rays: the loss is their mean."""

TASKS = ("09.3",)
LOSES = ("09.3.values", "09.3.hidden")
REPLACE = [
    (
        "return float(np.sum(residual**2) / len(residual)), 2 / len(residual) * residual",
        "return float(np.sum(residual**2)), 2 * residual",
    )
]
