"""The weights are differentiated as well; they are held fixed, as the directions are."""

TASKS = ("07.6",)
LOSES = ("07.6.cost", "07.6.differences", "07.6.hidden")
REPLACE = [
    (
        "return d_base_color, d_roughness\n",
        (
            "eps = 1e-5\n"
            '    near = brdf_pdf({**scene, "roughness": scene["roughness"] + eps}, both, '
            "ways)\n"
            "    moved = mis_weight(np.where(by_lamp, own, near), np.where(by_lamp, near, "
            "other))\n"
            "    slope = (moved - mis_weight(own, other)) / eps\n"
            "    shade = np.sum(d_f * brdf(scene, both, ways), axis=1)\n"
            "    extra = np.where(counts, shade * slope / np.where(counts, mis_weight(own, "
            "other), 1.0), 0.0)\n"
            '    np.add.at(d_roughness, both["thing"], extra)\n'
            "    return d_base_color, d_roughness\n"
        ),
    )
]
