"""Your furnace exchanges wo and wi: the first argument of f is the viewer."""

TASKS = ("04.1",)
LOSES = ("04.1.matte", "04.1.shapes", "04.1.burley", "04.1.hidden")
REPLACE = [("(solid_angles * wi[:, 2]) @ f(wo, wi)", "(solid_angles * wi[:, 2]) @ f(wi, wo)")]
