"""Your sign goes with the degree, (-1)^l: in equation (8) it goes with the order, (-1)^m."""

TASKS = ("11.1", "11.3")
LOSES = ("11.1.first", "11.1.signs", "11.1.hidden", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ("    return (-1) ** m * np.sqrt(share if m == 0 else 2 * share)\n"),
        ("    return (-1) ** ell * np.sqrt(share if m == 0 else 2 * share)\n"),
    )
]
