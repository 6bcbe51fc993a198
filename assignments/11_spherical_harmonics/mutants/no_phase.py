"""Your harmonics of odd m have the other sign: the phase (-1)^m of equation (8) is missing."""

TASKS = ("11.1", "11.3")
LOSES = ("11.1.first", "11.1.signs", "11.1.hidden", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ("    return (-1) ** m * np.sqrt(share if m == 0 else 2 * share)\n"),
        ("    return np.sqrt(share if m == 0 else 2 * share)\n"),
    )
]
