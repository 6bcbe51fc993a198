"""Your d_roughness lacks Fresnel's factors: they multiply the lobe."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.straight", "04.6.hidden")
REPLACE = [
    (
        ("mirrored = ((1 - m) * F)[:, None] + m[:, None] * schlick(base_color, cos[:, None])"),
        "mirrored = np.ones((len(m), 3))",
    )
]
