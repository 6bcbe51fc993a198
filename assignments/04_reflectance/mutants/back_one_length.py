"""Your derivative of V has the viewer's length alone: the light's changes as well."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.hidden")
REPLACE = [
    (
        ("of_V = alpha * (flat_o * i[:, 2] / long_o + flat_i * o[:, 2] / long_i) / L"),
        "of_V = alpha * flat_o * i[:, 2] / long_o / L",
    )
]
