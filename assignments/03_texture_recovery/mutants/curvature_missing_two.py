"""Your estimate lacks a factor 2: the Hessian is 2/N times the adjoint of the samples."""

TASKS = ("03.4",)
LOSES = ("03.4.rounds", "03.4.bound", "03.4.hidden")
REPLACE = [
    (
        "np.sum(x * loss_and_grad(x, uv, nothing)[1]) / np.sum(x * x)",
        "np.sum(x * loss_and_grad(x, uv, nothing)[1]) / np.sum(x * x) / 2",
    )
]
