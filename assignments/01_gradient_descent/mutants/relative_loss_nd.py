"""your values are differences to the first value: return the values of f themselves"""

TASKS = ("01.3",)
LOSES = ("01.3.rates",)
REPLACE = [
    (
        "    loss = np.array([f(each) for each in x])\n    return x, loss,",
        "    loss = np.array([f(each) for each in x])\n    return x, loss - loss[0],",
    )
]
