"""Your lobe takes light from below the surface."""

TASKS = ("04.2",)
LOSES = ("04.2.below",)
REPLACE = [
    (
        (
            "up = above(wo, wi)\n"
            "    o, i, alpha = wo[up], wi[up], roughness[up] ** 2\n"
            "    h = half_vector(o, i)"
        ),
        (
            "up = (wo[:, 2] > 0) & (np.abs(wi[:, 2]) > 0)\n"
            "    o, i, alpha = wo[up], wi[up] * np.sign(wi[up, 2:]), roughness[up]"
            " ** 2\n"
            "    h = half_vector(o, i)"
        ),
    )
]
