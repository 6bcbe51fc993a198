"""your verdict looks at the last step only: compare the last value with the first"""

TASKS = ("01.3",)
LOSES = ("01.3.stability",)
REPLACE = [
    (
        (
            "    loss = np.array([f(each) for each in x])\n"
            "    return x, loss, not loss[n] <= loss[0]"
        ),
        (
            "    loss = np.array([f(each) for each in x])\n"
            "    return x, loss, not loss[n] <= loss[n - 1]"
        ),
    )
]
