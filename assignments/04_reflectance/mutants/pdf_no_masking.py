"""Your density lacks masking: the facets seen look as large as the surface, not larger."""

TASKS = ("04.3",)
LOSES = ("04.3.ball", "04.3.weight", "04.3.hidden")
REPLACE = [
    (
        "pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (o[:, 2] + length)",
        "pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (2 * o[:, 2])",
    )
]
