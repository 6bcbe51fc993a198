"""Your losses are one step late: losses[0] belongs to T0."""

TASKS = ("03.5",)
LOSES = ("03.5.step", "03.5.chain")
REPLACE = [
    (
        ("        losses[k], d_T = loss_and_grad(T, uv, target)\n        T = T - step * d_T"),
        (
            "        _, d_T = loss_and_grad(T, uv, target)\n"
            "        T = T - step * d_T\n"
            "        losses[k] = loss_and_grad(T, uv, target)[0]"
        ),
    )
]
