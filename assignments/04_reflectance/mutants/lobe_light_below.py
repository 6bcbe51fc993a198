"""Your lobe takes light from below the surface."""

TASKS = ("04.2",)
LOSES = (
    "04.2.symmetry",
    "04.2.below",
    "04.2.energy",
    "04.2.hidden",
)
REPLACE = [
    (
        (
            "up = above(wo, wi)\n"
            "    o, i, alpha = wo[up], wi[up], roughness[up] ** 2\n"
            "    h = half_vector(o, i)"
        ),
        (
            "up = (wo[:, 2] > 0) & (np.abs(wi[:, 2]) > 0)\n"
            "    o, i, alpha = wo[up], np.abs(wi[up]), roughness[up] ** 2\n"
            "    h = half_vector(o, i)"
        ),
    ),
]
