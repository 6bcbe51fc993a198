"""The recurrence starts at 1 for each order: it starts at 1 x 3 x ... x (2 m - 1)."""

TASKS = ("11.1", "11.3")
LOSES = ("11.1.addition", "11.1.gram", "11.1.hidden", "11.3.vectors", "11.3.hidden", "11.3.cost")
REPLACE = [(("        Q[m, m] = np.prod(np.arange(1, 2 * m, 2))\n"), ("        Q[m, m] = 1\n"))]
