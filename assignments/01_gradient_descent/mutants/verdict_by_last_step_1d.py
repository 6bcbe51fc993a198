"""your verdict compares the last value with the one before: compare it with the first"""

TASKS = ("01.2",)
LOSES = ("01.2.verdict",)
REPLACE = [
    (
        "        x[k + 1] = x[k] - tau * df(float(x[k]))\n"
        "    loss = np.array([f(float(each)) for each in x])\n"
        "    return x, loss, not loss[n] <= loss[0]",
        "        x[k + 1] = x[k] - tau * df(float(x[k]))\n"
        "    loss = np.array([f(float(each)) for each in x])\n"
        "    return x, loss, not loss[n] <= loss[max(n - 1, 0)]",
    )
]
