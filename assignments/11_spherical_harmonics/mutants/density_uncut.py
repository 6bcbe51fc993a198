"""Your density goes below zero: cut it off after each step."""

TASKS = ("11.6",)
LOSES = ("11.6.first",)
REPLACE = [
    (
        ("            density = np.maximum(of_density.step(density, d_density), 0)\n"),
        ("            density = of_density.step(density, d_density)\n"),
    )
]
