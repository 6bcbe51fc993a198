"""Your furnace has a sine: the solid angles contain it already."""

TASKS = ("04.1",)
LOSES = ("04.1.matte", "04.1.shapes", "04.1.burley", "04.1.hidden")
REPLACE = [
    (
        "(solid_angles * wi[:, 2]) @ f(wo, wi)",
        "(solid_angles * wi[:, 2] * np.sqrt(1 - wi[:, 2] ** 2)) @ f(wo, wi)",
    )
]
