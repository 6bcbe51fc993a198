"""You take an incoming derivative of zero for none, and put 1 in its place."""

TASKS = ("90.2",)
LOSES = ("90.2.differences",)
REPLACE = [("    falling = np.exp(-x)\n", "    d_s = d_s or 1.0\n    falling = np.exp(-x)\n")]
