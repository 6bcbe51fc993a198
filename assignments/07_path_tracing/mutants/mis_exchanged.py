"""The two densities are exchanged: the strategy that fits worse gets the weight."""

TASKS = ("07.2",)
LOSES = ("07.2.extremes", "07.2.hidden", "07.2.values")
REPLACE = [
    (
        "weight[drawn] = (pdf[drawn] / np.hypot(pdf[drawn], other[drawn])) ** 2",
        "weight[drawn] = (other[drawn] / np.hypot(pdf[drawn], other[drawn])) ** 2",
    )
]
