"""The radiance of the lamp is missing."""

TASKS = ("07.3",)
LOSES = (
    "07.3.hidden",
    "07.3.matte",
)
REPLACE = [
    (
        (
            "total += np.where(lit, scale, 0.0)[:, None] * brdf(scene, hit, way) * "
            "emitted(scene, there)"
        ),
        "total += np.where(lit, scale, 0.0)[:, None] * brdf(scene, hit, way)",
    ),
]
