"""You cut the density off after the last step of a level: do so after each step."""

TASKS = ("11.6",)
LOSES = ("11.6.first",)
REPLACE = [
    (
        ("            density = np.maximum(of_density.step(density, d_density), 0)\n"),
        ("            density = of_density.step(density, d_density)\n"),
    ),
    (
        ("            losses.append(value)\n"),
        ("            losses.append(value)\n        density = np.maximum(density, 0)\n"),
    ),
]
