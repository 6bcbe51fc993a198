"""Your furnace divides by pi, as if every surface were matte: f has its own 1 / pi."""

TASKS = ("04.1",)
LOSES = ("04.1.matte", "04.1.shapes", "04.1.burley", "04.1.hidden")
REPLACE = [
    ("(solid_angles * wi[:, 2]) @ f(wo, wi)", "(solid_angles * wi[:, 2]) @ f(wo, wi) / np.pi")
]
