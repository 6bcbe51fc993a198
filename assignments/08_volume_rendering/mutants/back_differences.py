"""Your adjoint calls the forward function once a voxel: right, but far too dear."""

TASKS = ("08.5",)
LOSES = ("08.5.hidden",)
REPLACE = [
    (
        "    d_grid = np.zeros((*shape, g.shape[1]))\n",
        (
            "    d_grid = np.zeros((*shape, g.shape[1]))\n"
            "    for voxel in np.ndindex(*shape):\n"
            "        unit = np.zeros((*shape, 1))\n"
            "        unit[voxel] = 1.0\n"
            "        d_grid[voxel] = np.sum(trilinear(unit, u) * g, axis=0)\n"
            "    return d_grid\n"
        ),
    )
]
