"""d_t is multiplied by the cosine; it is to be divided."""

TASKS = ("05.4",)
LOSES = ("05.4.derivative", "05.4.hidden")
REPLACE = [
    (
        "d_t[done] = -by_parameter[there] / np.sum(gradient[there] * directions[done], axis=1)",
        "d_t[done] = -by_parameter[there] * np.sum(gradient[there] * directions[done], axis=1)",
    )
]
