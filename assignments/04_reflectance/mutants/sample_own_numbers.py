"""You draw numbers of your own: those that are given decide."""

TASKS = ("04.4",)
LOSES = ("04.4.rows",)
REPLACE = [
    ("phi = 2 * np.pi * u2[:, 1]", "phi = 2 * np.pi * np.random.default_rng(0).random(len(wo))")
]
