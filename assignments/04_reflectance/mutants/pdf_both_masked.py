"""Your density counts only facets that the light sees, too: they are drawn for the viewer alone."""

TASKS = ("04.3",)
LOSES = ("04.3.ball", "04.3.mass", "04.3.hidden",)
REPLACE = [
    ('pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (o[:, 2] + length)', 'pdf[up] = ggx_lobe(o, i, roughness[up]) * 2 * L / (4 * o[:, 2]) * 2 * o[:, 2] * i[:, 2] / L'),
]
