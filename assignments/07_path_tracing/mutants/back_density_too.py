"""The densities are differentiated as well: that has another mean."""

TASKS = ("07.6",)
LOSES = ("07.6.cost", "07.6.differences", "07.6.hidden", "07.6.mean")
REPLACE = [
    (
        "return d_base_color, d_roughness\n",
        (
            "eps = 1e-5\n"
            '    near = {**scene, "roughness": scene["roughness"] + eps}\n'
            "    slope = np.where(counts, (brdf_pdf(near, both, ways) - of_brdf) / eps, 0.0)\n"
            "    shade = np.sum(d_f * brdf(scene, both, ways), axis=1)\n"
            "    extra = -shade * np.where(by_lamp, 0.0, slope) / np.where(counts, "
            "of_brdf, 1.0)\n"
            '    np.add.at(d_roughness, both["thing"], extra)\n'
            "    return d_base_color, d_roughness\n"
        ),
    )
]
