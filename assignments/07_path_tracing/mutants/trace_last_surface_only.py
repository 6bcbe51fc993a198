"""Only the last surface multiplies; the factors of all surfaces belong together."""

TASKS = ("07.5",)
LOSES = ("07.5.furnace",)
REPLACE = [
    (
        "beta = np.where(pdf > 0, share, 0.0)[:, None] * beta * brdf(scene, hit, wi)",
        "beta = np.where(pdf > 0, share, 0.0)[:, None] * brdf(scene, hit, wi)",
    ),
]
