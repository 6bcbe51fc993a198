"""Your varnish mirrors 0.2 straight on: of an index of 1.5 it is ((1.5 - 1) / (1.5 + 1))^2."""

TASKS = ("04.5",)
LOSES = ("04.5.straight", "04.5.energy", "04.5.hidden")
REPLACE = [
    (
        (
            "cos = np.sum(wo * half_vector(wo, wi), axis=1)[:, None]\n"
            "    F = schlick(0.04, cos)\n"
            "    ground"
        ),
        (
            "cos = np.sum(wo * half_vector(wo, wi), axis=1)[:, None]\n"
            "    F = schlick(0.2, cos)\n"
            "    ground"
        ),
    )
]
