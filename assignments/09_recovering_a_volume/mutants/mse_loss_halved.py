"""Your loss is half of equation (7), which has no factor before it."""

TASKS = ("09.3",)
LOSES = ("09.3.values", "09.3.differences", "09.3.chain", "09.3.hidden")
REPLACE = [
    (
        "return float(np.sum(residual**2) / len(residual)),",
        "return float(np.sum(residual**2) / len(residual) / 2),",
    )
]
