"""Your harmonics of order 0 have the factor 2 under the root: it belongs to m > 0 alone."""

TASKS = ("11.1", "11.3")
LOSES = ("11.1.first", "11.1.addition", "11.1.gram", "11.1.hidden", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ("    return (-1) ** m * np.sqrt(share if m == 0 else 2 * share)\n"),
        ("    return (-1) ** m * np.sqrt(2 * share)\n"),
    )
]
