"""Your density never moves."""

TASKS = ("11.6",)
LOSES = ("11.6.first", "11.6.gain", "11.6.hidden")
REPLACE = [(("            density = np.maximum(of_density.step(density, d_density), 0)\n"), (""))]
