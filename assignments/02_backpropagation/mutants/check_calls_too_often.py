"""You call f anew for the gradient at each coordinate; 2 N + 1 calls are enough."""

TASKS = ("02.6",)
LOSES = ("02.6.accepts",)
REPLACE = [
    (
        "        step = eps * max",
        """\
        gradient = np.asarray(f(x.copy())[1], dtype=np.float64)
        step = eps * max""",
    )
]
