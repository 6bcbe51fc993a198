"""your verdict compares |x|; a minimum need not lie at zero: compare the values of f"""

TASKS = ("01.2",)
LOSES = ("01.2.verdict",)
REPLACE = [
    (
        (
            "    loss = np.array([f(float(each)) for each in x])\n"
            "    return x, loss, not loss[n] <= loss[0]"
        ),
        (
            "    loss = np.array([f(float(each)) for each in x])\n"
            "    return x, loss, not abs(x[n]) <= abs(x[0])"
        ),
    )
]
