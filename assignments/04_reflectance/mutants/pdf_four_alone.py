"""Your density divides by 4 alone: in equation (12) stands 4 times the cosine."""

TASKS = ("04.3",)
LOSES = ("04.3.ball", "04.3.mass", "04.3.weight", "04.3.hidden")
REPLACE = [
    (
        "pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (o[:, 2] + length)",
        (
            "h = half_vector(o, i)\n"
            "    pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (o[:, 2] + length) *"
            " np.sum(o * h, axis=1)"
        ),
    )
]
