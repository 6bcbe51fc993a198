"""Your harmonics have a mean square of 1: it is the integral that should be 1."""

TASKS = ("11.1", "11.3")
LOSES = ("11.1.first", "11.1.addition", "11.1.gram", "11.1.hidden", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        (
            "    share = (2 * ell + 1) / (4 * np.pi) / np.prod(np.arange(ell - m + 1, ell "
            "+ m + 1))\n"
        ),
        ("    share = (2 * ell + 1) / np.prod(np.arange(ell - m + 1, ell + m + 1))\n"),
    )
]
