"""The root of the squares is taken in the divisor, and the square above is missing."""

TASKS = ("07.2",)
LOSES = ("07.2.extremes", "07.2.hidden", "07.2.sum", "07.2.values")
REPLACE = [
    (
        "weight[drawn] = (pdf[drawn] / np.hypot(pdf[drawn], other[drawn])) ** 2",
        "weight[drawn] = pdf[drawn] / np.hypot(pdf[drawn], other[drawn])",
    )
]
