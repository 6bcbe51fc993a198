"""Each strategy counts half, whatever its density: as noisy as the worse one."""

TASKS = ("07.2",)
LOSES = ("07.2.extremes", "07.2.hidden", "07.2.values")
REPLACE = [
    (
        "weight[drawn] = (pdf[drawn] / np.hypot(pdf[drawn], other[drawn])) ** 2",
        "weight[drawn] = 0.5",
    )
]
