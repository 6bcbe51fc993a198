"""Your density is the lobe times the cosine: that is what the weights divide by it."""

TASKS = ("04.3",)
LOSES = ("04.3.ball", "04.3.mass", "04.3.hidden")
REPLACE = [
    (
        "pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (o[:, 2] + length)",
        "pdf[up] = ggx_lobe(o, i, roughness[up]) * i[:, 2]",
    )
]
