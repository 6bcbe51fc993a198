"""Your d_base_color is f itself times d_f: f is not only the colour times something."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.linear", "04.6.hidden")
REPLACE = [
    (
        "return d_f * by_color[:, None], ",
        "return d_f * gltf(wo, wi, base_color, metalness, roughness), ",
    )
]
