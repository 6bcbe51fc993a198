"""Your varnish is coloured: a dielectric mirrors all colours alike."""

TASKS = ("04.5",)
LOSES = ("04.5.straight", "04.5.hidden")
REPLACE = [
    (
        ("return (1 - m) * ((1 - F) * ground + F * lobe) + m * schlick(base_color, cos) * lobe"),
        (
            "return (1 - m) * ((1 - F) * ground + F * base_color * lobe) + m *"
            " schlick(base_color, cos) * lobe"
        ),
    )
]
