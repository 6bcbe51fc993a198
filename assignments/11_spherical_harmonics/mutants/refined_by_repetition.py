"""You copy each cell to its eight parts: blend, so that even slopes stay."""

TASKS = ("11.6",)
LOSES = ("11.6.refine", "11.6.hidden")
REPLACE = [
    (
        ("            p = (np.stack(np.indices(fine), axis=-1).reshape(-1, 3) + 0.5) / 2 - 0.5\n"),
        (
            "            p = (np.stack(np.indices(fine), axis=-1).reshape(-1, 3) + 0.5) / "
            "2 - 0.5\n"
            "            p = np.rint(p)\n"
        ),
    )
]
