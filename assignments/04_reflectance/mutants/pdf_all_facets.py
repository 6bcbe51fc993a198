"""Your density is that of all facets: those that the viewer does not see are drawn as well."""

TASKS = ("04.3",)
LOSES = ("04.3.ball", "04.3.weight", "04.3.hidden")
REPLACE = [
    (
        "pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (o[:, 2] + length)",
        (
            "h = half_vector(o, i)\n"
            "    pdf[up] = ggx_lobe(o, i, roughness[up]) * 2 * L * h[:, 2] / (4 *"
            " np.sum(o * h, axis=1))"
        ),
    )
]
