"""Your adjoint calls the forward function once a texel: right, but far too dear."""

TASKS = ("03.2",)
LOSES = ("03.2.cost",)
REPLACE = [
    (
        ("    d_T = np.zeros((height, width, g.shape[1]))\n"),
        (
            "    d_T = np.zeros((height, width, g.shape[1]))\n"
            "    for i in range(height):\n"
            "        for j in range(width):\n"
            "            unit = np.zeros((height, width, 1))\n"
            "            unit[i, j] = 1.0\n"
            "            d_T[i, j] = np.sum(bilinear_sample(unit, uv) * g, axis=0)\n"
            "    return d_T\n"
        ),
    )
]
