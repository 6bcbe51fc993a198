"""Lamps that a path finds after a bounce are added, though direct light has counted them."""

TASKS = ("07.5",)
LOSES = ("07.5.furnace", "07.5.hidden", "07.5.integral")
REPLACE = [
    (
        "radiance[live] += beta * direct_light(scene, hit, *fresh[:2])",
        (
            "radiance[live] += beta * direct_light(scene, hit, *fresh[:2])\n"
            "        radiance[live] += (bounce > 0) * beta * emitted(scene, hit)"
        ),
    )
]
