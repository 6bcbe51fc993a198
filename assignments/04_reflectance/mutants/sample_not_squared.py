"""Your stretch is the roughness: it is the roughness squared."""

TASKS = ("04.4",)
LOSES = ("04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [
    ("[roughness**2, roughness**2, np.ones(len(wo))]", "[roughness, roughness, np.ones(len(wo))]")
]
