"""The derivative by roughness is made of differences: two renderings for each thing."""

TASKS = ("07.6",)
LOSES = ("07.6.cost",)
REPLACE = [
    (
        'np.add.at(d_roughness, both["thing"], by_rough)',
        (
            "for what in range(things):\n"
            "        ends = []\n"
            "        for step in (1e-5, -1e-5):\n"
            '            moved = {**scene, "roughness": scene["roughness"].copy()}\n'
            '            moved["roughness"][what] += step\n'
            "            seen = direct_light(moved, hit, u_light, u_surface, scene)\n"
            "            ends.append(np.vdot(seen, d_radiance))\n"
            "        d_roughness[what] = (ends[0] - ends[1]) / 2e-5"
        ),
    )
]
