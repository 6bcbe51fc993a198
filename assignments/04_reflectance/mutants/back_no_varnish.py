"""Your d_roughness lacks the varnish: it is as rough as the metal."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.straight", "04.6.hidden")
REPLACE = [
    (
        ("mirrored = ((1 - m) * F)[:, None] + m[:, None] * schlick(base_color, cos[:, None])"),
        "mirrored = m[:, None] * schlick(base_color, cos[:, None])",
    )
]
