"""Your d_base_color takes the metal's Fresnel factor for the base colour: the ramp takes a part."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.linear", "04.6.hidden")
REPLACE = [
    (
        (
            "by_color = above(wo, wi) * (1 - m) * (1 - F) / np.pi + m * (1 -"
            " schlick(0.0, cos)) * lobe"
        ),
        "by_color = above(wo, wi) * (1 - m) * (1 - F) / np.pi + m * lobe",
    )
]
