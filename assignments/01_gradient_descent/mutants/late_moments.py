"""you move with the moments of the step before: update them first"""

TASKS = ("01.5",)
LOSES = ("01.5.constant", "01.5.trace", "01.5.sums")
REPLACE = [
    (
        "        g = grad(x[k - 1])\n",
        "        g_now, g = grad(x[k - 1]), np.zeros(len(x0)) if k == 1 else g_now\n",
    )
]
