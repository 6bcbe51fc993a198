"""The factor 2 under the root for m > 0 is missing: those harmonics are too small."""

TASKS = ("11.1", "11.3")
LOSES = ("11.1.first", "11.1.addition", "11.1.gram", "11.1.hidden", "11.3.hidden", "11.3.cost")
REPLACE = [
    (
        ("    return (-1) ** m * np.sqrt(share if m == 0 else 2 * share)\n"),
        ("    return (-1) ** m * np.sqrt(share)\n"),
    )
]
