"""Your density changes at each refinement: it is per length, and lengths stay."""

TASKS = ("11.6",)
LOSES = ("11.6.refine", "11.6.hidden")
REPLACE = [
    (
        ("            density = np.sum(weight * density.ravel()[index], axis=0).reshape(fine)\n"),
        (
            "            density = np.sum(weight * density.ravel()[index], "
            "axis=0).reshape(fine) * 2\n"
        ),
    )
]
