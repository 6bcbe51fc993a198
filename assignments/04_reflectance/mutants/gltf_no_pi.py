"""Your ground lacks 1 / pi."""

TASKS = ("04.5",)
LOSES = ("04.5.straight", "04.5.energy", "04.5.hidden")
REPLACE = [
    (
        "ground = above(wo, wi)[:, None] * base_color / np.pi",
        "ground = above(wo, wi)[:, None] * base_color",
    )
]
