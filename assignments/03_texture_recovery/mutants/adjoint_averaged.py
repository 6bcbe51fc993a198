"""Your adjoint divides by the summed weights: it averages where it should add."""

TASKS = ("03.2",)
LOSES = ("03.2.single", "03.2.transpose", "03.2.repeated", "03.2.hidden", "03.2.cost")
REPLACE = [
    (
        ("    return d_T\n"),
        (
            "    total = np.zeros((height, width, 1))\n"
            "    for i, a in ((i0, 1 - fv), (i1, fv)):\n"
            "        for j, b in ((j0, 1 - fu), (j1, fu)):\n"
            "            np.add.at(total, (i, j), a * b)\n"
            "    return d_T / np.maximum(total, 1e-12)\n"
        ),
    )
]
