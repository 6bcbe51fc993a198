"""your values are those of the point before"""

TASKS = ("01.2",)
LOSES = ("01.2.rate", "01.2.verdict")
REPLACE = [
    (
        "np.array([f(float(each)) for each in x])",
        "np.array([f(float(each)) for each in x[[0, *range(n)]]])",
    )
]
