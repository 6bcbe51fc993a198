"""The gradient is made of differences, two renderings for each number: far too dear."""

TASKS = ("07.6",)
LOSES = ()
REPLACE = [
    (
        (
            'd_base_color, d_roughness = np.zeros((len(scene["matte"]), 3)), '
            'np.zeros(len(scene["matte"]))'
        ),
        (
            "results = []\n"
            '    for name in ("base_color", "roughness"):\n'
            "        slopes = np.zeros(scene[name].shape)\n"
            "        for index in np.ndindex(slopes.shape):\n"
            "            ends = []\n"
            "            for step in (1e-5, -1e-5):\n"
            "                moved = {**scene, name: scene[name].copy()}\n"
            "                moved[name][index] += step\n"
            "                rendered = direct_light(moved, hit, u_light, u_surface, scene)\n"
            "                ends.append(float(np.vdot(rendered, d_radiance)))\n"
            "            slopes[index] = (ends[0] - ends[1]) / 2e-5\n"
            "        results.append(slopes)\n"
            "    return results[0] * (np.abs(results[0]) > 1e-9), results[1] * "
            "(np.abs(results[1]) > 1e-9)\n"
            '    d_base_color, d_roughness = np.zeros((len(scene["matte"]), 3)), '
            'np.zeros(len(scene["matte"]))'
        ),
    ),
]
