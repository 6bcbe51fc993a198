"""The reflectance is that of the proposal; it must be that of the scene."""

TASKS = ("07.3",)
LOSES = (
    "07.3.hidden",
    "07.3.proposal",
)
REPLACE = [
    (
        (
            "total += np.where(lit, scale, 0.0)[:, None] * brdf(scene, hit, way) * "
            "emitted(scene, there)"
        ),
        (
            "total += np.where(lit, scale, 0.0)[:, None] * brdf(drawn_by, hit, way) * "
            "emitted(scene, there)"
        ),
    ),
]
