"""The weights of both strategies do not sum to 1."""

TASKS = ("07.2",)
LOSES = ("07.2.extremes", "07.2.hidden", "07.2.sum", "07.2.values")
REPLACE = [
    (
        "weight[drawn] = (pdf[drawn] / np.hypot(pdf[drawn], other[drawn])) ** 2",
        ("weight[drawn] = np.minimum(1.0, (pdf[drawn] / np.maximum(other[drawn], 1e-300)) ** 2)"),
    )
]
