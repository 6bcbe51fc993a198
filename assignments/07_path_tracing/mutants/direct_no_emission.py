"""The radiance of the lamp is missing."""

TASKS = ("07.3",)
LOSES = ("07.3.hidden", "07.3.matte")
REPLACE = [
    (
        "total += scale[:, None] * brdf(scene, hit, way) * emitted(scene, there)",
        "total += scale[:, None] * brdf(scene, hit, way) * (emitted(scene, there) > 0)",
    )
]
