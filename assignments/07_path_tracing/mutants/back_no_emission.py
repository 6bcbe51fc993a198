"""The radiance of the lamp is missing in the gradient."""

TASKS = ("07.6",)
LOSES = ("07.6.cost", "07.6.differences", "07.6.hidden")
REPLACE = [
    (
        "d_f = np.tile(d_radiance, (2, 1)) * factor[:, None] * emitted(scene, found)",
        ("d_f = np.tile(d_radiance, (2, 1)) * factor[:, None] * (emitted(scene, found) > 0)"),
    )
]
