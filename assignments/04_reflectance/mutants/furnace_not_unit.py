"""Your viewer's direction is no unit vector: x is the root of 1 - z^2."""

TASKS = ("04.1",)
LOSES = ("04.1.matte", "04.1.shapes", "04.1.hidden")
REPLACE = [("[np.sqrt(1 - z * z), 0.0, z]", "[1 - z, 0.0, z]")]
