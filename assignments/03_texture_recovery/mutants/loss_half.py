"""Your loss carries a factor 1/2 that equation (9) does not have."""

TASKS = ("03.3",)
LOSES = ("03.3.value", "03.3.hidden")
REPLACE = [
    ("loss = float(np.sum(residual**2)) / count", "loss = float(np.sum(residual**2)) / count / 2"),
    ("2 * residual / count", "residual / count"),
]
