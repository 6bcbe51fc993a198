"""The sign of the gradient is wrong."""

TASKS = ("07.6",)
LOSES = ("07.6.cost", "07.6.differences", "07.6.hidden", "07.6.mean", "07.6.recover")
REPLACE = [
    (
        "d_f = np.tile(d_radiance, (2, 1)) * factor[:, None] * emitted(scene, found)",
        "d_f = -np.tile(d_radiance, (2, 1)) * factor[:, None] * emitted(scene, found)",
    )
]
