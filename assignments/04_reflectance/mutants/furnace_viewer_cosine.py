"""Your furnace takes the cosine of the viewer: it is the light's that spreads."""

TASKS = ("04.1",)
LOSES = ("04.1.matte", "04.1.shapes", "04.1.burley", "04.1.hidden")
REPLACE = [("(solid_angles * wi[:, 2]) @ f(wo, wi)", "(solid_angles * wo[:, 2]) @ f(wo, wi)")]
