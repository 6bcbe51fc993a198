"""Your ground gets all the light: what the varnish mirrors does not reach it."""

TASKS = ("04.5",)
LOSES = ("04.5.straight", "04.5.energy", "04.5.hidden")
REPLACE = [
    (
        ("return (1 - m) * ((1 - F) * ground + F * lobe) + m * schlick(base_color, cos) * lobe"),
        ("return (1 - m) * (ground + F * lobe) + m * schlick(base_color, cos) * lobe"),
    )
]
