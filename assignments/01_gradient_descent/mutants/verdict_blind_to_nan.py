"""your verdict takes NaN for success: NaN > 1 is False, so ask for `not last <= first`"""

TASKS = ("01.2",)
LOSES = ("01.2.undefined",)
REPLACE = [
    (
        (
            "    loss = np.array([f(float(each)) for each in x])\n"
            "    return x, loss, not loss[n] <= loss[0]"
        ),
        (
            "    loss = np.array([f(float(each)) for each in x])\n"
            "    return x, loss, loss[n] > loss[0]"
        ),
    )
]
