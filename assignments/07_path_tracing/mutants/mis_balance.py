"""That is the balance heuristic; the power heuristic takes the squares of densities."""

TASKS = ("07.2",)
LOSES = ("07.2.extremes", "07.2.hidden", "07.2.values")
REPLACE = [
    (
        "weight[drawn] = (pdf[drawn] / np.hypot(pdf[drawn], other[drawn])) ** 2",
        "weight[drawn] = pdf[drawn] / (pdf[drawn] + other[drawn])",
    )
]
