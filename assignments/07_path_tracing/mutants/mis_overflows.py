"""Large densities are squared before they are divided, and become infinite."""

TASKS = ("07.2",)
LOSES = ("07.2.extremes",)
REPLACE = [
    (
        "weight[drawn] = (pdf[drawn] / np.hypot(pdf[drawn], other[drawn])) ** 2",
        (
            'with np.errstate(all="ignore"):\n'
            "        weight[drawn] = np.nan_to_num(pdf[drawn] ** 2 / (pdf[drawn] ** 2 + "
            "other[drawn] ** 2))"
        ),
    )
]
