"""your result is the formula with four values, of order 4; Eq. (3) has two"""

TASKS = ("01.1",)
LOSES = ("01.1.order", "01.1.cubic")
REPLACE = [
    (
        "(f(x + step) - f(x - step)) / (2.0 * eps)",
        (
            "(\n"
            "            8.0 * (f(x + step) - f(x - step))\n"
            "            - f(x + 2.0 * step) + f(x - 2.0 * step)\n"
            "        ) / (12.0 * eps)"
        ),
    )
]
