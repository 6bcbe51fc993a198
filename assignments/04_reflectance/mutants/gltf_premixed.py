"""You blend what goes into Fresnel's factor: blend the finished values."""

TASKS = ("04.5",)
LOSES = ("04.5.blend", "04.5.energy", "04.5.hidden")
REPLACE = [
    (
        ("return (1 - m) * ((1 - F) * ground + F * lobe) + m * schlick(base_color, cos) * lobe"),
        (
            "F = schlick((1 - m) * 0.04 + m * base_color, cos)\n"
            "    return (1 - m) * (1 - F) * ground + F * lobe"
        ),
    )
]
