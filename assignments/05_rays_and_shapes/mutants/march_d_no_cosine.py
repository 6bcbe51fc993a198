"""d_t is the distance's derivative; a slanted ray has farther to go for it."""

TASKS = ("05.4",)
LOSES = ("05.4.derivative", "05.4.hidden")
REPLACE = [
    (
        "d_t[done] = -by_parameter[there] / np.sum(gradient[there] * directions[done], axis=1)",
        "d_t[done] = -by_parameter[there]",
    )
]
