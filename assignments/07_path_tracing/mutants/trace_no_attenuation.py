"""Surfaces do not multiply: each bounce starts anew with factor 1."""

TASKS = ("07.5",)
LOSES = ("07.5.corner", "07.5.furnace", "07.5.hidden")
REPLACE = [
    (
        "radiance[live] += beta * direct_light(scene, hit, *fresh[:2])",
        "radiance[live] += direct_light(scene, hit, *fresh[:2])",
    )
]
