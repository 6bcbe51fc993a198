"""Your irradiance is the light in the direction of the normal: the cosine lobe is missing."""

TASKS = ("11.5",)
LOSES = ("11.5.constant", "11.5.lambert", "11.5.hidden")
REPLACE = [
    (("    lobe = np.pi * np.array([1, 2 / 3, 1 / 4, 0, -1 / 24])\n"), ("    lobe = np.ones(5)\n"))
]
