"""You draw with a generator of your own: use the one that you are given."""

TASKS = ("09.6",)
LOSES = ("09.6.draws", "09.6.hidden")
REPLACE = [(("    adam = Adam()\n"), ("    adam, rng = Adam(), np.random.default_rng(0)\n"))]
