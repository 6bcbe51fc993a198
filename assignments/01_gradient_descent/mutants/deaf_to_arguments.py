"""beta1, beta2 and eps are set inside: take the arguments"""

TASKS = ("01.5",)
LOSES = ("01.5.sums",)
REPLACE = [
    (
        "    m, v = np.zeros(len(x0)), np.zeros(len(x0))\n",
        (
            "    m, v = np.zeros(len(x0)), np.zeros(len(x0))\n"
            "    beta1, beta2, eps = 0.9, 0.999, 1e-8\n"
        ),
    )
]
