"""Your estimate is the length of the Hessian's image, not the Rayleigh quotient."""

TASKS = ("03.4",)
LOSES = ("03.4.rounds", "03.4.hidden")
REPLACE = [
    (
        "float(np.sum(x * loss_and_grad(x, uv, nothing)[1]) / np.sum(x * x))",
        "float(np.linalg.norm(loss_and_grad(x, uv, nothing)[1]) / np.linalg.norm(x))",
    )
]
