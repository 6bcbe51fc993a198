"""The root in equation (8) is missing."""

TASKS = ("11.1", "11.3")
LOSES = ("11.1.first", "11.1.addition", "11.1.gram", "11.1.hidden", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ("    return (-1) ** m * np.sqrt(share if m == 0 else 2 * share)\n"),
        ("    return (-1) ** m * (share if m == 0 else 2 * share)\n"),
    )
]
