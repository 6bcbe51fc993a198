"""Your metal has the base colour at all angles: at grazing ones it turns white."""

TASKS = ("04.5",)
LOSES = ("04.5.mirror", "04.5.hidden")
REPLACE = [
    (
        ("return (1 - m) * ((1 - F) * ground + F * lobe) + m * schlick(base_color, cos) * lobe"),
        "return (1 - m) * ((1 - F) * ground + F * lobe) + m * base_color * lobe",
    )
]
