"""you move one coordinate after the other: move all with the gradient at the old point"""

TASKS = ("01.3",)
LOSES = ("01.3.rates", "01.3.stability", "01.3.contraction")
REPLACE = [
    (
        "        x[k + 1] = x[k] - tau * grad(x[k])",
        (
            "        x[k + 1] = x[k]\n"
            "        for i in range(len(x0)):\n"
            "            x[k + 1, i] -= tau * grad(x[k + 1])[i]"
        ),
    )
]
