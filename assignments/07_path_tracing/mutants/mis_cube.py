"""The densities are cubed; the power heuristic squares them."""

TASKS = ("07.2",)
LOSES = ("07.2.extremes", "07.2.hidden", "07.2.values")
REPLACE = [
    (
        "weight[drawn] = (pdf[drawn] / np.hypot(pdf[drawn], other[drawn])) ** 2",
        (
            "most = np.maximum(pdf, other)[drawn]\n"
            "    p, q = (pdf[drawn] / most) ** 3, (other[drawn] / most) ** 3\n"
            "    weight[drawn] = p / (p + q)"
        ),
    )
]
