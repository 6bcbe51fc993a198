"""your step stays in the coordinates that were done before: begin each coordinate at x"""

TASKS = ("01.1",)
LOSES = ("01.1.quadratic",)
REPLACE = [
    (
        ("    for i in range(len(x)):\n        step = np.zeros(len(x))\n        step[i] = eps"),
        ("    step = np.zeros(len(x))\n    for i in range(len(x)):\n        step[i] = eps"),
    )
]
