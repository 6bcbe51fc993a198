"""Your d_base_color lacks the metal's part."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.linear", "04.6.hidden")
REPLACE = [
    (
        (
            "by_color = above(wo, wi) * (1 - m) * (1 - F) / np.pi + m * (1 -"
            " schlick(0.0, cos)) * lobe"
        ),
        "by_color = above(wo, wi) * (1 - m) * (1 - F) / np.pi",
    )
]
