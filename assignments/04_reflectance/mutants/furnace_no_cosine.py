"""Your furnace lacks the cosine: light from near the horizon is spread over more of the surface."""

TASKS = ("04.1",)
LOSES = ("04.1.matte", "04.1.shapes", "04.1.burley", "04.1.hidden")
REPLACE = [("(solid_angles * wi[:, 2]) @ f(wo, wi)", "solid_angles @ f(wo, wi)")]
