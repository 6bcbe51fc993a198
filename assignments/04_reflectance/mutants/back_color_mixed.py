"""Your d_base_color mixes the channels: each has its own."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.linear", "04.6.hidden")
REPLACE = [
    (
        "return d_f * by_color[:, None], ",
        ("return np.mean(d_f, axis=1, keepdims=True) * np.ones(3) * by_color[:, None], "),
    )
]
