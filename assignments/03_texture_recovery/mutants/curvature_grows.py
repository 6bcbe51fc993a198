"""You never scale x back to length 1: many rounds make it 0."""

TASKS = ("03.4",)
LOSES = ("03.4.bound",)
REPLACE = [(("        x = x / np.linalg.norm(x)\n"), "")]
