"""The sign of the gradient is wrong."""

TASKS = ("07.6",)
LOSES = ()
REPLACE = [
    (
        "d_f = np.tile(d_radiance, (2, 1)) * emitted(scene, found)",
        "d_f = -np.tile(d_radiance, (2, 1)) * emitted(scene, found)",
    ),
]
