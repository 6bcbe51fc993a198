"""The radiance of the lamp is missing in the gradient."""

TASKS = ("07.6",)
LOSES = ()
REPLACE = [
    (
        "d_f = np.tile(d_radiance, (2, 1)) * emitted(scene, found)",
        "d_f = np.tile(d_radiance, (2, 1)) * (emitted(scene, found) > 0)",
    ),
]
