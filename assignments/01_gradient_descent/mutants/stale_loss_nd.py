"""your values are those of the point before"""

TASKS = ("01.3",)
LOSES = ("01.3.rates", "01.3.stability")
REPLACE = [
    ("np.array([f(each) for each in x])", "np.array([f(each) for each in x[[0, *range(n)]]])")
]
