"""Your density divides by the half vector's height: mirrors turn by its angle to the viewer."""

TASKS = ("04.3",)
LOSES = ("04.3.ball", "04.3.weight", "04.3.hidden")
REPLACE = [
    (
        "pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (o[:, 2] + length)",
        (
            "h = half_vector(o, i)\n"
            "    pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (o[:, 2] + length) *"
            " np.sum(o * h, axis=1) / h[:, 2]"
        ),
    )
]
