"""Your material contains the cosine of the light: f does not."""

TASKS = ("04.5",)
LOSES = ("04.5.mirror", "04.5.symmetry", "04.5.energy", "04.5.hidden")
REPLACE = [
    (
        ("return (1 - m) * ((1 - F) * ground + F * lobe) + m * schlick(base_color, cos) * lobe"),
        (
            "return wi[:, 2:] * ((1 - m) * ((1 - F) * ground + F * lobe) + m *"
            " schlick(base_color, cos) * lobe)"
        ),
    )
]
