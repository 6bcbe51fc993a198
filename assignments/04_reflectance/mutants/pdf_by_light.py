"""Your density has the masking of the light: the viewer decides which facets are drawn."""

TASKS = ("04.3",)
LOSES = ("04.3.ball", "04.3.mass", "04.3.weight", "04.3.hidden")
REPLACE = [
    (
        "pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (o[:, 2] + length)",
        ("pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (i[:, 2] + stretched(i, alpha))"),
    )
]
