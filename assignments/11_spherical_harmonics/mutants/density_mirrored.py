"""You mirror negative densities: set them to zero."""

TASKS = ("11.6",)
LOSES = ("11.6.first",)
REPLACE = [
    (
        ("            density = np.maximum(of_density.step(density, d_density), 0)\n"),
        ("            density = np.abs(of_density.step(density, d_density))\n"),
    )
]
