"""Your d_roughness is a central difference: it has nine digits, the formula has all."""

TASKS = ("04.6",)
LOSES = ("04.6.straight", "04.6.hidden")
REPLACE = [
    (
        "    return d_f * by_color[:, None], ",
        (
            "    ends = [gltf(wo, wi, base_color, metalness, roughness + e) for e in"
            " (1e-5, -1e-5)]\n"
            "    d_roughness = np.sum(d_f * (ends[0] - ends[1]), axis=1) / 2e-5\n"
            "    return d_f * by_color[:, None], "
        ),
    )
]
