"""Your d_base_color is not 0 below the surface."""

TASKS = ("04.6",)
LOSES = ("04.6.zero",)
REPLACE = [
    (
        (
            "by_color = above(wo, wi) * (1 - m) * (1 - F) / np.pi + m * (1 -"
            " schlick(0.0, cos)) * lobe"
        ),
        ("by_color = (1 - m) * (1 - F) / np.pi + m * (1 - schlick(0.0, cos)) * lobe"),
    )
]
