"""The sign of d_t is wrong: a surface that comes nearer makes t smaller."""

TASKS = ("05.4",)
LOSES = ("05.4.derivative", "05.4.hidden")
REPLACE = [
    (
        "d_t[done] = -by_parameter[there] / np.sum(gradient[there] * directions[done], axis=1)",
        "d_t[done] = by_parameter[there] / np.sum(gradient[there] * directions[done], axis=1)",
    )
]
