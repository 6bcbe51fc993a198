"""Your density is half of what it should be: the 2 of the masking and the 4 of equation (12)."""

TASKS = ("04.3",)
LOSES = ("04.3.ball", "04.3.mass", "04.3.weight", "04.3.hidden")
REPLACE = [
    (
        "pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (o[:, 2] + length)",
        "pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (o[:, 2] + length) / 2",
    )
]
