"""Your furnace takes all directions for equally large: weigh each with its solid angle."""

TASKS = ("04.1",)
LOSES = ("04.1.matte", "04.1.shapes", "04.1.burley", "04.1.hidden")
REPLACE = [
    ("(solid_angles * wi[:, 2]) @ f(wo, wi)", "2 * np.pi * np.mean(wi[:, 2:] * f(wo, wi), axis=0)")
]
