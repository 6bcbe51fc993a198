"""Your highest degree is left at zero."""

TASKS = ("11.1",)
LOSES = ("11.1.first", "11.1.addition", "11.1.gram", "11.1.signs", "11.1.hidden")
REPLACE = [
    (
        (
            "    for ell in range(degree + 1):\n"
            "        for m in range(ell + 1):\n"
            "            Y[:, ell * (ell + 1) - m]"
        ),
        (
            "    for ell in range(max(degree, 1)):\n"
            "        for m in range(ell + 1):\n"
            "            Y[:, ell * (ell + 1) - m]"
        ),
    )
]
