"""The reflectance is that of the proposal; it must be that of the scene."""

TASKS = ("07.3",)
LOSES = ("07.3.hidden", "07.3.proposal")
REPLACE = [
    (
        "total += scale[:, None] * brdf(scene, hit, way) * emitted(scene, there)",
        "total += scale[:, None] * brdf(drawn_by, hit, way) * emitted(scene, there)",
    )
]
