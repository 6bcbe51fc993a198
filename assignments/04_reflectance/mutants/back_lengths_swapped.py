"""Your derivative of V pairs the lengths with the wrong cosines."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.hidden")
REPLACE = [
    (
        ("of_V = alpha * (flat_o * i[:, 2] / long_o + flat_i * o[:, 2] / long_i) / L"),
        ("of_V = alpha * (flat_o * o[:, 2] / long_o + flat_i * i[:, 2] / long_i) / L"),
    )
]
