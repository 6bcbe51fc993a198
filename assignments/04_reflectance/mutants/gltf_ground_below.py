"""Your ground shines below the surface."""

TASKS = ("04.5",)
LOSES = ("04.5.symmetry",)
REPLACE = [("ground = above(wo, wi)[:, None] * base_color / np.pi", "ground = base_color / np.pi")]
