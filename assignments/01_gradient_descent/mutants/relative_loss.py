"""your values are differences to the first value: return the values of f themselves"""

TASKS = ("01.2",)
LOSES = ("01.2.rate",)
REPLACE = [
    (
        "    loss = np.array([f(float(each)) for each in x])\n    return x, loss,",
        "    loss = np.array([f(float(each)) for each in x])\n    return x, loss - loss[0],",
    )
]
