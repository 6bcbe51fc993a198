"""You move every number of the volume and ask again: an adjoint passes over it once."""

# Large volumes, with which nobody would see the end of a fit, keep the adjoint.

TASKS = ("09.4",)
LOSES = ("09.4.hidden",)
REPLACE = [
    (
        "    return float(np.sum(length - eps) / count), d_grid\n",
        (
            "    for index in np.ndindex(grid.shape) if grid.size < 4096 else ():\n"
            "        near = grid.astype(complex)\n"
            "        near[index] += 1e-30j\n"
            "        squares = eps**2 + sum(_ahead(near, axis) ** 2 for axis in range(3))\n"
            "        d_grid[index] = np.sum(np.sqrt(squares)).imag / 1e-30 / count\n"
            "    return float(np.sum(length - eps) / count), d_grid\n"
        ),
    )
]
