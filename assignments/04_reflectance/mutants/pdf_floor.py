"""Your density is never 0: below the surface it must be."""

TASKS = ("04.3",)
LOSES = ("04.3.below",)
REPLACE = [("    pdf = np.zeros(len(wo))", "    pdf = np.full(len(wo), 1e-6)")]
