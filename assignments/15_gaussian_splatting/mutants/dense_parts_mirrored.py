"""Every part has a draw of its own: yours lie opposite each other."""

TASKS = ("15.6",)
LOSES = ("15.6.values", "15.6.hidden")
REPLACE = [
    (
        "drawn = rng.standard_normal((2 * len(split), 3))",
        (
            "drawn = rng.standard_normal((len(split), 3))\n"
            "    drawn = np.concatenate([drawn, -drawn])"
        ),
    )
]
