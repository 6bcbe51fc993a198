"""Your Fresnel factor takes the half vector's angle to the normal: it is that to the viewer."""

TASKS = ("04.5",)
LOSES = ("04.5.mirror", "04.5.energy", "04.5.hidden")
REPLACE = [
    (
        (
            "cos = np.sum(wo * half_vector(wo, wi), axis=1)[:, None]\n"
            "    F = schlick(0.04, cos)\n"
            "    ground"
        ),
        ("cos = half_vector(wo, wi)[:, 2:]\n    F = schlick(0.04, cos)\n    ground"),
    )
]
